#include "experiment/demo_resources.h"

// The assembler copies the files into the program: no generated source of many megabytes.
#define MAREY_EMBED(symbol, file)         \
  asm(".section .rodata\n"                \
      ".balign 16\n" #symbol              \
      "_begin:\n"                         \
      ".incbin \"" file "\"\n" #symbol    \
      "_end:\n"                           \
      ".byte 0\n"                         \
      ".previous\n");                     \
  extern "C" const char symbol##_begin[]; \
  extern "C" const char symbol##_end[];

MAREY_EMBED(marey_demo_model, MAREY_DEMO_FOLDER "/demo.marey")
MAREY_EMBED(marey_demo_experiment, MAREY_DEMO_FOLDER "/experiment.json")

namespace marey {

std::string_view demoModel() {
  return {marey_demo_model_begin, marey_demo_model_end};
}
std::string_view demoExperiment() {
  return {marey_demo_experiment_begin, marey_demo_experiment_end};
}

}  // namespace marey

# The reader of PyTorch checkpoints: no libtorch, so that it builds in seconds.
if(NOT MAREY_TRAIN_ONLY)
  marey_library(marey_torch_pickle
    SOURCES pickle_calls.cpp pickle_literals.cpp pickle_machine.cpp pickle_names.cpp state_dicts.cpp
            torch_flatten.cpp torch_pickle.cpp
            torch_views.cpp utf8.cpp
    PUBLIC marey_base)
endif()

// Seeds of the text readers: what programs and people do to a good file.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

#include "base/atomic_file.h"

namespace marey {

inline std::string replacedOnce(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline std::string asUtf16(const std::string& text, bool big, bool mark) {
  std::string out = !mark ? "" : big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) {
    if (big) out += '\0';
    out += c;
    if (!big) out += '\0';
  }
  return out;
}

inline std::string withLineEnds(const std::string& text, const std::string& end) {
  std::string out;
  for (const char c : text) out += c == '\n' ? end : std::string(1, c);
  return out;
}

/// Encodings, line ends, remarks and padding of any text.
inline void writeTextKinds(const std::filesystem::path& folder, const std::string& text) {
  const auto write = [&folder](const char* name, const std::string& content) {
    writeFileAtomically(folder / name, content);
  };
  write("plain", text);
  write("mark", "\xEF\xBB\xBF" + text);
  write("utf16_le", asUtf16(text, false, true));
  write("utf16_be", asUtf16(text, true, true));
  write("utf16_bare", asUtf16(text, false, false));
  write("cr", withLineEnds(text, "\r"));
  write("crlf", withLineEnds(text, "\r\n"));
  write("cr_crlf", withLineEnds(text, "\r\r\n"));
  write("remarks", "# one\n// two\n" + text + "# three\n");
  write("padded", text + std::string(64, '\0') + "\x1A");
  write("nuls", replacedOnce(text, "\n", std::string("\0\n", 2)));
}

/// Two joints, six channels each, two frames: small, so that mutations hit what matters.
inline std::string smallBvh() {
  return "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0 0\n  CHANNELS 6 Xposition Yposition Zposition "
         "Zrotation Xrotation Yrotation\n  JOINT LeftLeg\n  {\n    OFFSET 0 44 0\n    CHANNELS 3 "
         "Zrotation Xrotation Yrotation\n    End Site\n    {\n      OFFSET 0 40 0\n    }\n  }\n}\n"
         "MOTION\nFrames: 2\nFrame Time: 0.033333\n0 90 0 1 2 3 4 5 6\n0 90 1 2 3 4 5 6 7\n";
}

inline void writeBvhKinds(const std::filesystem::path& folder) {
  const std::string text = smallBvh();
  writeTextKinds(folder, text);
  const std::string tree = text.substr(0, text.find("MOTION"));
  const std::string body = tree.substr(tree.find("ROOT"));
  const auto write = [&](const char* name, const std::string& from, const std::string& to) {
    writeFileAtomically(folder / name, replacedOnce(text, from, to));
  };
  write("one_row_more", "Frames: 2", "Frames: 1");
  write("one_row_less", "Frames: 2", "Frames: 3");
  write("last_row_cut", " 6 7\n", "\n");
  write("no_count", "Frames: 2\n", "");
  write("no_time", "Frame Time: 0.033333\n", "");
  write("odd_header", "MOTION\nFrames: 2\nFrame Time: 0.033333",
        "MOTION FRAMES 2 FrameTime :.033333");
  write("wrapped", "4 5 6\n0 90 1 2 3 4 5 6 7", "4\n5 6\n0 90 1 2 3\n4 5 6 7");
  write("one_line", "6\n0 90 1", "6 0 90 1");
  write("channels_wrapped", "Zposition Zrotation", "Zposition\nZrotation");
  write("brace_on_line", "Hips\n{", "Hips {");
  write("odd_name", "LeftLeg", "\x8E\xF1\x83{");
  write("blanks", "LeftLeg", "Bip01 L, \"Thigh\"");
  write("zero_offsets", "OFFSET 0 44 0", "OFFSET 0 0 0");
  write("before", "HIERARCHY", "exported\nHIERARCHY");
  writeFileAtomically(folder / "text_after", text + "end of capture\n");
  writeFileAtomically(folder / "put_together", text + text);
  writeFileAtomically(folder / "two_roots", "HIERARCHY\n" + body + body +
                                                "MOTION\nFrames: 1\nFrame Time: 0.05\n"
                                                "0 90 0 1 2 3 4 5 6 0 90 1 2 3 4 5 6 7\n");
  writeFileAtomically(folder / "prop",
                      "HIERARCHY\nROOT Ball\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\n}\n" + body +
                          "MOTION\nFrames: 1\nFrame Time: 0.05\n5 0 90 1 2 3 4 5 6 7\n");
}

/// ASF and AMC with a NUL between, as asf_amc_fuzz.cpp takes them.
inline void writeAcclaimKinds(const std::filesystem::path& folder, const std::string& asf,
                              const std::string& amc) {
  const auto write = [&folder](const char* name, const std::string& a, const std::string& b) {
    writeFileAtomically(folder / name, a + '\0' + b);
  };
  write("plain", asf, amc);
  write("cr", withLineEnds(asf, "\r"), withLineEnds(amc, "\r"));
  write("mark", "\xEF\xBB\xBF" + asf, "\xEF\xBB\xBF" + amc);
  write("rate", asf, replacedOnce(amc, ":DEGREES", ":DEGREES\n:SAMPLES-PER-SECOND 60\n:ODD thing"));
  write("length", replacedOnce(asf, "dof rx ry rz", "dof rx ry rz l"),
        replacedOnce(replacedOnce(amc, "leg 1 2 3", "leg 1 2 3 0"), "leg 0 0 0", "leg 0 0 0 0"));
  write("orientation", replacedOnce(asf, "orientation 0 0 0", "orientation 0 90 0"), amc);
  write("unit", replacedOnce(asf, "length 0.45", "length 2.54"), amc);
  write("section", replacedOnce(asf, ":bonedata", ":odd\n thing\n:bonedata"), amc);
}

}  // namespace marey

#include "base/file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

namespace marey {
namespace {

using namespace std::string_view_literals;

constexpr auto kDownloadAgain = "download it again, or copy it again from where it came from"sv;
constexpr auto kSaveStateDict =
    "in the program that wrote it, save the weights alone with torch.save(model.state_dict(), "
    "FILE)"sv;
constexpr auto kLoadAndSave =
    "load it where it was made and save what is needed: weights with "
    "torch.save(model.state_dict(), FILE), motion with numpy.savez"sv;
constexpr auto kUnpack = "unpack it and give the files in it"sv;
constexpr auto kExportMotion = "export BVH from the program that wrote it"sv;

/// Bytes at a fixed place.
struct Magic {
  size_t at;
  std::string_view bytes;
  std::string_view id, name, advice;
};

constexpr std::array kMagics{
    Magic{0, "\x89HDF\r\n\x1a\n"sv, "hdf5", "an HDF5 file, as Keras, h5py and MATLAB 7.3 write",
          "save its arrays with numpy.savez or torch.save"},
    Magic{0, "\x93NUMPY"sv, "npy", "a NumPy array (.npy)", ""},
    Magic{0, "\x1f\x8b"sv, "gzip", "a gzip archive", kUnpack},
    Magic{0, "BZh"sv, "bzip2", "a bzip2 archive", kUnpack},
    Magic{0,
          "\xfd"
          "7zXZ\0"sv,
          "xz", "an xz archive", kUnpack},
    Magic{0, "\x28\xb5\x2f\xfd"sv, "zstd", "a Zstandard archive", kUnpack},
    Magic{0, "\x04\x22\x4d\x18"sv, "lz4", "an LZ4 archive", kUnpack},
    Magic{0, "7z\xbc\xaf\x27\x1c"sv, "7z", "a 7-Zip archive", kUnpack},
    Magic{0, "Rar!\x1a\x07"sv, "rar", "a RAR archive", kUnpack},
    Magic{257, "ustar"sv, "tar", "a tar archive", kUnpack},
    Magic{0, "PK\x05\x06"sv, "zip", "a zip archive with nothing in it", kDownloadAgain},
    Magic{0, "\x80\x02\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19"sv, "torch",
          "a PyTorch checkpoint", ""},
    Magic{0, "Kaydara FBX Binary"sv, "fbx", "an FBX file", kExportMotion},
    Magic{0, "; FBX "sv, "fbx", "an FBX file", kExportMotion},
    Magic{0, "glTF"sv, "glb", "a glTF scene", kExportMotion},
    Magic{0, "PathFileType"sv, "trc", "a TRC file of markers", kExportMotion},
    Magic{0, "NO_OF_FRAMES"sv, "tsv", "a Qualisys TSV file of markers", kExportMotion},
    Magic{0, "Vocaloid Motion Data"sv, "vmd", "a MikuMikuDance motion (VMD)", kExportMotion},
    Magic{0, "PXR-USDC"sv, "usd", "a USD scene", kExportMotion},
    Magic{0, "#usda "sv, "usd", "a USD scene", kExportMotion},
    Magic{0, "BLENDER"sv, "blend", "a Blender file", kExportMotion},
    Magic{0, "Ogawa"sv, "abc", "an Alembic scene", kExportMotion},
    Magic{0, "MATLAB 5.0 MAT-file"sv, "mat", "a MATLAB file",
          "save its arrays with numpy.savez (scipy.io.loadmat reads them)"},
    Magic{4, "TFL3"sv, "tflite", "a TensorFlow Lite model", kSaveStateDict},
    Magic{0, "GGUF"sv, "gguf", "a GGUF model", kSaveStateDict},
    Magic{0, "SQLite format 3\0"sv, "sqlite", "an SQLite data base", ""},
    Magic{0, "%PDF-"sv, "pdf", "a PDF document", ""},
    Magic{0, "\x89PNG\r\n\x1a\n"sv, "png", "a PNG picture", ""},
    Magic{0, "\xff\xd8\xff"sv, "jpeg", "a JPEG picture", ""},
    Magic{0, "GIF8"sv, "gif", "a GIF picture", ""},
    Magic{4, "ftyp"sv, "mp4", "an MP4 or QuickTime video", ""},
    Magic{0, "\x1a\x45\xdf\xa3"sv, "mkv", "a Matroska or WebM video", ""},
    Magic{0, "RIFF"sv, "riff", "a RIFF file (AVI or WAV)", ""},
    Magic{0, "\xff\xfe"sv, "utf-16", "a text in UTF-16", "save it as UTF-8"},
    Magic{0, "\xfe\xff"sv, "utf-16", "a text in UTF-16", "save it as UTF-8"},
    Magic{0,
          "\x7f"
          "ELF"sv,
          "elf", "a program", ""},
    Magic{0, "\0\x05\x16\x07"sv, "apple-double",
          "what macOS keeps beside a file (its name begins with '._')", "give the file itself"},
};

constexpr std::array kPageStarts{"<!doctype html"sv, "<html"sv,  "<head"sv, "<body"sv,
                                 "<script"sv,        "<title"sv, "<meta"sv, "<!--"sv};

FileKind kindOf(std::string_view id, std::string_view name, std::string_view advice = {}) {
  return {std::string(id), std::string(name), std::string(advice)};
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// Without a byte-order mark and leading blanks.
std::string_view textStart(std::string_view head) {
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  const size_t begin = head.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos ? std::string_view() : head.substr(begin);
}

/// Texts that stand for a file that is kept elsewhere.
std::optional<FileKind> pointerKind(std::string_view text) {
  if (text.starts_with("version https://git-lfs.github.com/spec/") ||
      text.starts_with("version https://hawser.github.com/spec/"))
    return kindOf("git-lfs", "a Git LFS pointer in place of the file",
                  "fetch the file with 'git lfs pull'");
  if (text.starts_with("/annex/objects/") ||
      text.substr(0, 200).find(".git/annex/objects/") != std::string_view::npos)
    return kindOf("git-annex", "a git-annex pointer in place of the file",
                  "fetch the file with 'git annex get'");
  if (text.starts_with("outs:") && text.find("md5:") != std::string_view::npos)
    return kindOf("dvc", "a DVC pointer in place of the file", "fetch the file with 'dvc pull'");
  if (text.starts_with("XSym\n"))
    return kindOf("link", "a link of another system in place of the file", kDownloadAgain);
  return std::nullopt;
}

std::optional<FileKind> markupKind(std::string_view text) {
  if (text.empty() || text[0] != '<') return std::nullopt;
  const std::string start = lower(text);
  if (start.find("<collada") != std::string::npos)
    return kindOf("dae", "a COLLADA scene", kExportMotion);
  const bool xml = start.starts_with("<?xml");
  const bool page = xml ? start.find("<html") != std::string::npos
                        : std::any_of(kPageStarts.begin(), kPageStarts.end(),
                                      [&](std::string_view tag) { return start.starts_with(tag); });
  if (page)
    return kindOf("html", "an HTML page in place of the file",
                  "download it again: what came was a page to log in, to confirm or with an error");
  if (xml || start.starts_with("<error"))
    return kindOf("xml", "an XML document", "if it came from a download, that failed");
  return std::nullopt;
}

std::optional<FileKind> textKind(std::string_view head) {
  const std::string_view text = textStart(head);
  if (auto kind = pointerKind(text)) return kind;
  if (auto kind = markupKind(text)) return kind;
  if (text.starts_with("HIERARCHY")) return kindOf("bvh", "a BVH motion file");
  if (text.starts_with(":version")) return kindOf("asf", "an ASF skeleton", "give its AMC file");
  if (text.starts_with("{") || text.starts_with("[")) {
    if (text.find("\"asset\"") != std::string_view::npos && looksLikeText(head))
      return kindOf("gltf", "a glTF scene", kExportMotion);
    if (text.size() > 1 && text.find_first_of("\"{[]}", 1) != std::string_view::npos &&
        looksLikeText(head))
      return kindOf("json", "a JSON document");
  }
  if (text.find("\nendheader") != std::string_view::npos && looksLikeText(head))
    return kindOf("opensim", "an OpenSim table (MOT or STO)", kExportMotion);
  return std::nullopt;
}

/// A zip archive by the name of its first entry.
std::optional<FileKind> zipKind(std::string_view head) {
  if (!head.starts_with("PK\x03\x04") || head.size() < 30) return std::nullopt;
  const auto length = static_cast<size_t>(static_cast<unsigned char>(head[26])) |
                      static_cast<size_t>(static_cast<unsigned char>(head[27])) << 8U;
  const std::string_view first = head.substr(30, length);
  if (first.ends_with(".npy")) return kindOf("npz", "an NPZ archive");
  if (first.ends_with("/data.pkl") || first.ends_with("/version") || first.ends_with("/byteorder"))
    return kindOf("torch", "a PyTorch checkpoint");
  if (first.starts_with("[Content_Types]") || first.starts_with("_rels/"))
    return kindOf("office", "an Office document");
  if (first.find("saved_model.pb") != std::string_view::npos ||
      first.find("keras_metadata") != std::string_view::npos)
    return kindOf("tensorflow", "a TensorFlow model in a zip archive", kSaveStateDict);
  const bool keras = first == "metadata.json" || first == "model.weights.h5" ||
                     (first == "config.json" && head.find("keras") != std::string_view::npos);
  if (keras) return kindOf("keras", "a Keras model in a zip archive", kSaveStateDict);
  return kindOf("zip", "a zip archive", kUnpack);
}

/// Length of a JSON header in eight bytes, then the header.
std::optional<FileKind> safetensorsKind(std::string_view head) {
  if (head.size() < 10 || head[8] != '{') return std::nullopt;
  uint64_t length = 0;
  std::memcpy(&length, head.data(), sizeof(length));
  if (length < 2 || length > 100'000'000 || (head[9] != '"' && head[9] != '}' && head[9] != ' '))
    return std::nullopt;
  if (head.find("\"marey\"") != std::string_view::npos)
    return kindOf("marey", "a Marey model or data set");
  return kindOf("safetensors", "a safetensors file");
}

/// The protocol buffers of two model formats: a version, then the name of the program that wrote it
/// (ONNX) or the bytes of a graph (TensorFlow).
std::optional<FileKind> protobufKind(std::string_view head) {
  if (head.size() < 8 || head[0] != '\x08' || head[1] < 1 || head[1] > 30 || head[2] != '\x12')
    return std::nullopt;
  const auto length = static_cast<size_t>(static_cast<unsigned char>(head[3]));
  const std::string_view producer = head.substr(4, length);
  if (length > 0 && length < 80 && producer.size() == length &&
      std::all_of(producer.begin(), producer.end(),
                  [](unsigned char c) { return std::isprint(c) != 0; }))
    return kindOf("onnx", "an ONNX model", kSaveStateDict);
  if (head[1] == '\x01') return kindOf("tensorflow", "a TensorFlow SavedModel", kSaveStateDict);
  return std::nullopt;
}

std::optional<FileKind> otherBinaryKind(std::string_view head) {
  if (auto kind = zipKind(head)) return kind;
  if (auto kind = protobufKind(head)) return kind;
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(head[i]); };
  if (head.size() >= 2 && byte(1) == 0x50 && byte(0) >= 2 && byte(0) < 64 && !looksLikeText(head))
    return kindOf("c3d", "a C3D file of markers", kExportMotion);
  if (head.size() >= 2 && byte(0) == 0x80 && byte(1) >= 2 && byte(1) <= 5)
    return kindOf("pickle", "a Python pickle", kLoadAndSave);
  if (head.size() >= 2 && byte(0) == 0x78 && (byte(1) == 0x9c || byte(1) == 0xda || byte(1) == 1))
    return kindOf("zlib", "zlib-compressed data, as joblib writes it", kLoadAndSave);
  if (head.size() >= 4 && std::all_of(head.begin(), head.end(), [](char c) { return c == '\0'; }))
    return kindOf("zeros", "a file of zeros (damaged, or never written to its end)",
                  kDownloadAgain);
  return std::nullopt;
}

}  // namespace

std::string FileKind::text() const {
  return advice.empty() ? name : name + " (" + advice + ")";
}

std::optional<FileKind> fileKind(std::string_view head) {
  head = head.substr(0, kFileHeadBytes);
  if (head.empty()) return kindOf("empty", "an empty file", kDownloadAgain);
  // First, for the length that it begins with may look like any magic number.
  if (auto kind = safetensorsKind(head)) return kind;
  for (const Magic& magic : kMagics)
    if (head.size() >= magic.at + magic.bytes.size() &&
        head.substr(magic.at, magic.bytes.size()) == magic.bytes)
      return kindOf(magic.id, magic.name, magic.advice);
  if (auto kind = textKind(head)) return kind;
  return otherBinaryKind(head);
}

bool looksLikeText(std::string_view head) {
  head = head.substr(0, kFileHeadBytes);
  return !head.empty() && std::all_of(head.begin(), head.end(), [](unsigned char c) {
    return c >= 0x20 ? c != 0x7f : (c >= '\t' && c <= '\r') || c == 0x1a;
  });
}

std::string quotedStart(std::string_view content, size_t most) {
  std::string out = "'";
  for (const unsigned char c : content.substr(0, most))
    out += c >= 0x20 && c < 0x7f ? static_cast<char>(c) : '?';
  return out + (content.size() > most ? "...'" : "'");
}

std::string describeContent(std::string_view head) {
  if (const auto kind = fileKind(head)) return kind->text();
  return (looksLikeText(head) ? "a text that begins with " : "a file that begins with ") +
         quotedStart(head);
}

}  // namespace marey

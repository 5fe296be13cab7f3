// Contents that other programs write, recognised by their first bytes.
#include "base/file_kind.h"

#include "unit/base/support.h"
#include <gtest/gtest.h>

namespace marey {
namespace {

using namespace std::string_literals;
using test::slurp;

std::string idOf(const std::string& content) {
  const auto kind = fileKind(content);
  return kind ? kind->id : "";
}

std::string fixture(const std::string& name) {
  return slurp(std::filesystem::path(MAREY_SOURCE_DIR) / "tests" / "fixtures" / name);
}

TEST(FileKinds, Case33AreNamedWithWhatToDo) {
  const std::string folder = "33-not-a-checkpoint/";
  const std::pair<const char*, const char*> expected[] = {
      {"git_lfs_pointer.pkg", "Git LFS pointer in place of the file (fetch the file with 'git lfs"},
      {"web_page.pkg", "an HTML page in place of the file (download it again"},
      {"model.safetensors", "a safetensors file"},
      {"keras.h5", "an HDF5 file"},
      {"empty.pkg", "an empty file (download it again"}};
  for (const auto& [name, text] : expected)
    EXPECT_NE(describeContent(fixture(folder + name)).find(text), std::string::npos)
        << name << ": " << describeContent(fixture(folder + name));
  EXPECT_EQ(idOf(fixture(folder + "half_downloaded.pkg")), "torch");
}

TEST(FileKinds, OfArraysAndCheckpointsAreTold) {
  EXPECT_EQ(idOf(fixture("26-numpy-arrays/joints_22.npy")), "npy");
  EXPECT_EQ(idOf(fixture("27-npz-dialects/f4.npz")), "npz");
  EXPECT_EQ(idOf(fixture("28-checkpoint-key-prefixes/compiled.pkg")), "torch");
  EXPECT_EQ(idOf(fixture("36-no-display/walk.bvh")), "bvh");
}

TEST(FileKinds, OfPointersPagesAndPicturesAreTold) {
  const std::pair<std::string, const char*> contents[] = {
      {"\xef\xbb\xbf\r\n <HTML lang='en'><body>404", "html"},
      {"<?xml version='1.0'?><!DOCTYPE html PUBLIC ''><html>", "html"},
      {"<?xml version='1.0'?><Error><Code>AccessDenied</Code>", "xml"},
      {"<?xml version='1.0'?>\n<COLLADA xmlns=''>", "dae"},
      {"version https://hawser.github.com/spec/v1\noid", "git-lfs"},
      {"../../.git/annex/objects/aa/bb/SHA256E-s12", "git-annex"},
      {"outs:\n- md5: 0123\n  path: model.pt\n", "dvc"},
      {"\x1f\x8b\x08\x00"s, "gzip"},
      {std::string(257, 'a') + "ustar\0"s, "tar"},
      {"; FBX 7.7.0 project file", "fbx"},
      {"{\"asset\": {\"version\": \"2.0\"}}", "gltf"},
      {"{\"pose_dim\": 63}", "json"},
      {"\x80\x04\x95\x10\0\0\0\0\0\0\0\x8c\x0f"
       "sklearn.pipeline"s,
       "pickle"},
      {"\x08\x07\x12\x07pytorch\x1a\x05"
       "1.9.0"s,
       "onnx"},
      {"\x08\x01\x12\xc3\x9f\x24\x0a\x99\x13\x0a"s, "tensorflow"},
      {"\x02\x50\x01\x00"s + std::string(508, '\0'), "c3d"},
      {std::string(64, '\0'), "zeros"},
      {"\xff\xfeH\0I\0E\0"s, "utf-16"},
      {"inverse kinematics\nnRows=1\nendheader\ntime\tx\n", "opensim"}};
  for (const auto& [content, id] : contents) EXPECT_EQ(idOf(content), id) << quotedStart(content);
}

TEST(FileKinds, OfTensorFilesHoldWhateverTheirLengthLooksLike) {
  // Header lengths whose bytes are the magic numbers of gzip and of UTF-16.
  for (const char* length : {"\x1f\x8b", "\xff\xfe", "\x02\x50"}) {
    const std::string start = length + std::string(6, '\0');
    EXPECT_EQ(idOf(start + "{\"__metadata__\":{\"format\":\"marey\",\"marey\":\"{}\"}"), "marey");
    EXPECT_EQ(idOf(start + "{\"a\":{\"dtype\":\"F32\"}"), "safetensors");
  }
}

TEST(FileKinds, OfArchivesFollowTheFirstNameInThem) {
  const auto zip = [](const std::string& name) {
    std::string out = "PK\x03\x04" + std::string(22, '\0');
    out += static_cast<char>(name.size());
    return out + std::string(3, '\0') + name + "content";
  };
  EXPECT_EQ(idOf(zip("poses.npy")), "npz");
  EXPECT_EQ(idOf(zip("archive/data.pkl")), "torch");
  EXPECT_EQ(idOf(zip("model.weights.h5")), "keras");
  EXPECT_EQ(idOf(zip("export/saved_model.pb")), "tensorflow");
  EXPECT_EQ(idOf(zip("[Content_Types].xml")), "office");
  EXPECT_EQ(idOf(zip("walk.bvh")), "zip");
}

TEST(FileKinds, OfNothingKnownQuoteTheBeginning) {
  EXPECT_EQ(describeContent("0.1,0.2\n"), "a text that begins with '0.1,0.2?'");
  EXPECT_EQ(describeContent("\x01\x02z"),
            "a file that begins with '?"
            "?z'");
  EXPECT_EQ(describeContent(std::string(60, 'x')),
            "a text that begins with '" + std::string(40, 'x') + "...'");
}

TEST(FileKinds, CutAtAnyLengthStayNamed) {
  for (const char* name : {"33-not-a-checkpoint/half_downloaded.pkg", "27-npz-dialects/f4.npz",
                           "33-not-a-checkpoint/keras.h5"}) {
    const std::string content = fixture(name).substr(0, 600);
    for (size_t length = 0; length <= content.size(); ++length)
      EXPECT_FALSE(describeContent(content.substr(0, length)).empty());
  }
}

}  // namespace
}  // namespace marey

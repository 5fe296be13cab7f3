#include "pickle/torch_checkpoint.h"

#include <algorithm>
#include <cstring>

#include "pickle/flatten.h"
#include "pickle/names.h"
#include "pickle/utf8.h"

#include "base/archive.h"
#include "base/atomic_file.h"
#include "base/file_kind.h"

namespace marey {
namespace {

using pickle::Arena;
using pickle::Flattener;
using pickle::Machine;
using pickle::Storages;
using pickle::TensorReader;
using pickle::Value;
using Kind = Value::Kind;

constexpr size_t kMaxPickleBytes = size_t{64} << 20;
constexpr std::string_view kLegacyMagic{"\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19", 10};
constexpr int64_t kLegacyProtocol = 1001;

using Files = std::map<std::string, std::string>;

/// The folder of the archive that holds the checkpoint, with its '/'.
std::string checkpointFolder(const Files& files, const std::string& origin,
                             const std::string& archiveKind) {
  const std::string_view wanted = "/data.pkl";
  const auto data = std::find_if(files.begin(), files.end(), [&](const auto& file) {
    return file.first.ends_with(wanted) &&
           file.first.find('/') == file.first.size() - wanted.size();
  });
  if (data == files.end()) throw InputError({.path = origin}, "a PyTorch checkpoint", archiveKind);
  return data->first.substr(0, data->first.size() - wanted.size() + 1);
}

TorchCheckpoint parseZip(std::string_view bytes, const std::string& origin,
                         const TorchTensorFilter& filter) {
  const Files files = parseArchive(bytes, origin);
  const std::string folder =
      checkpointFolder(files, origin, describeContent(bytes) + ", without data.pkl");
  if (files.contains(folder + "constants.pkl"))
    throw InputError({.path = origin}, "a checkpoint of torch.save",
                     "a TorchScript program (save the weights with torch.save(model.state_dict(), "
                     "FILE))");
  const auto order = files.find(folder + "byteorder");
  if (order != files.end() && order->second != "little")
    throw InputError({.path = origin}, "little-endian storages", pickle::printable(order->second));
  const std::string& object = files.at(folder + "data.pkl");
  if (object.size() > kMaxPickleBytes)
    throwInput({.path = origin}, fmt::format("a data.pkl of at most {} bytes", kMaxPickleBytes),
               "{}", object.size());
  Storages storages;
  for (const auto& [name, content] : files) {
    if (!name.starts_with(folder + "data/")) continue;
    storages.bytes[name.substr(folder.size() + 5)] = content;
    storages.totalBytes += content.size();
  }
  Arena arena;
  const Value* root = Machine(object, 0, origin, arena).run();
  TensorReader reader(storages, origin);
  return Flattener(reader, filter, origin).flatten(*root);
}

/// The tensors alone: the format holds nothing else.
TorchCheckpoint parseSafetensors(std::string_view bytes, const std::string& origin,
                                 const TorchTensorFilter& filter) {
  TorchCheckpoint out;
  out.isSafetensors = true;
  TensorFile file = parseTensorFile(bytes, origin + " (a safetensors file)");
  for (auto& [name, tensor] : file.tensors) {
    if (!filter || filter(name))
      out.tensors.emplace(name, std::move(tensor));
    else
      out.skipped.push_back(name);
  }
  return out;
}

/// The stream before PyTorch 1.6: five pickles (magic number, protocol, system, object, storage
/// keys), then for every key an element count in 8 bytes and the raw values.
class LegacyStream {
 public:
  LegacyStream(std::string_view bytes, std::string origin)
      : m_bytes(bytes), m_origin(std::move(origin)) {}

  TorchCheckpoint read(const TorchTensorFilter& filter) {
    checkHeader();
    const Value* root = next();
    const Storages storages = readStorages(*next());
    TensorReader reader(storages, m_origin);
    return Flattener(reader, filter, m_origin).flatten(*root);
  }

 private:
  const Value* next() {
    // The pickles come before the raw values and are small beside them.
    Machine machine(m_bytes.substr(0, m_position + kMaxPickleBytes), m_position, m_origin, m_arena);
    const Value* out = machine.run();
    m_position = machine.position();
    return out;
  }
  void checkHeader();
  Storages readStorages(const Value& keys);
  using ElementSizes = std::unordered_map<std::string, size_t>;
  ElementSizes elementSizes() const;
  Place place(std::string item = {}) const { return {.path = m_origin, .item = std::move(item)}; }

  std::string_view m_bytes;
  std::string m_origin;
  size_t m_position = 0;
  Arena m_arena;
};

void LegacyStream::checkHeader() {
  const Value* magic = next();
  if (magic->kind != Kind::BigInt || magic->text != kLegacyMagic)
    throw InputError(place(), "a PyTorch checkpoint",
                     "another pickle; " + pickle::adviceFor("object"));
  const Value* protocol = next();
  if (protocol->kind != Kind::Int || protocol->integer != kLegacyProtocol)
    throw InputError(place(), fmt::format("stream version {}", kLegacyProtocol), "another");
  const Value* system = next();
  const auto& items = system->items;
  for (size_t i = 0; system->kind == Kind::Dict && i + 1 < items.size(); i += 2)
    if (items[i]->text == "little_endian" && items[i + 1]->integer != 1)
      throw InputError(place(), "little-endian storages", "big-endian ones");
}

/// All references to a storage must agree on its type: the stream does not state it.
LegacyStream::ElementSizes LegacyStream::elementSizes() const {
  ElementSizes out;
  for (const Value& value : m_arena.values()) {
    if (value.kind != Kind::Storage) continue;
    const size_t size = value.storage->element.bytes();
    if (out.emplace(value.storage->key, size).first->second != size)
      throwInput(place(), "one type for each storage", "two for storage '{}'",
                 pickle::printable(value.storage->key));
  }
  return out;
}

Storages LegacyStream::readStorages(const Value& keys) {
  if (keys.kind != Kind::List)
    throw InputError(place(), "a list of storage keys", pickle::describe(keys.kind));
  const ElementSizes sizes = elementSizes();
  Storages out;
  for (const Value* key : keys.items) {
    if (key->kind != Kind::Text)
      throw InputError(place(), "text as storage key", pickle::describe(key->kind));
    const Place storage = place("storage '" + pickle::printable(key->text) + "'");
    uint64_t count = 0;
    if (m_bytes.size() - m_position < sizeof(count))
      throw InputError(storage, "a size in 8 bytes", "the end of the file (is it cut?)");
    std::memcpy(&count, m_bytes.data() + m_position, sizeof(count));
    m_position += sizeof(count);
    const auto known = sizes.find(key->text);
    if (known == sizes.end()) throw InputError(storage, "a tensor that refers to it", "none");
    const size_t item = known->second;
    const size_t left = m_bytes.size() - m_position;
    if (count > left / item)
      throwInput(storage, fmt::format("{} values of {} bytes", count, item),
                 "{} bytes (is the file cut?)", left);
    if (!out.bytes.emplace(key->text, m_bytes.substr(m_position, count * item)).second)
      throw InputError(storage, "every storage once", "twice");
    out.totalBytes += count * item;
    m_position += count * item;
  }
  if (m_position != m_bytes.size())
    throwInput(place(), "the end of the file after the storages", "{} more bytes",
               m_bytes.size() - m_position);
  return out;
}

}  // namespace

TorchCheckpoint parseTorchCheckpoint(std::string_view bytes, const std::string& origin,
                                     const TorchTensorFilter& filter) {
  if (bytes.starts_with("PK")) return parseZip(bytes, origin, filter);
  // 0x80 starts pickles of protocol 2 and later; the other two start hand-made ones, for which
  // the name they ask for is the better message.
  if (!bytes.empty() && std::string_view("\x80"
                                         "c(")
                                .find(bytes[0]) != std::string_view::npos)
    return LegacyStream(bytes, origin).read(filter);
  const auto kind = fileKind(bytes);
  if (kind && kind->id == "safetensors") return parseSafetensors(bytes, origin, filter);
  throw InputError({.path = origin}, "a PyTorch checkpoint (zip container or legacy stream)",
                   describeContent(bytes));
}

TorchCheckpoint readTorchCheckpoint(const std::filesystem::path& path,
                                    const TorchTensorFilter& filter) {
  return parseTorchCheckpoint(readFile(path), path.string(), filter);
}

}  // namespace marey

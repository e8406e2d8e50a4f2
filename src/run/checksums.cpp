// SPDX-License-Identifier: BSD-3-Clause
#include "run/checksums.hpp"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <memory>
#include <vector>

#include "edgevox/io/atomic_file.hpp"

namespace edgevox {
namespace {

namespace fs = std::filesystem;

constexpr size_t kDigits = 64;
constexpr size_t kNameAt = kDigits + 2;  // after a space and the mark of text or binary
constexpr size_t kBlock = size_t{1} << 16;

using Digest = std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)>;

std::string hexOf(const unsigned char* bytes, size_t size) {
  constexpr const char* kHex = "0123456789abcdef";
  std::string text;
  for (size_t i = 0; i < size; ++i) {
    text += kHex[bytes[i] >> 4];
    text += kHex[bytes[i] & 15];
  }
  return text;
}

bool isEntry(const std::string& line) {
  return line.size() > kNameAt && line[kDigits] == ' ' &&
         line.find_first_not_of("0123456789abcdef") == kDigits &&
         line.find('/', kNameAt) == std::string::npos && line[kNameAt] != '.';
}

}  // namespace

std::string sha256Of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const Digest digest(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  bool good = in.good() && EVP_DigestInit_ex(digest.get(), EVP_sha256(), nullptr) == 1;
  std::vector<char> block(kBlock);
  while (good && in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    good = EVP_DigestUpdate(digest.get(), block.data(), static_cast<size_t>(in.gcount())) == 1;
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> sum{};
  unsigned size = 0;
  good = good && in.eof() && EVP_DigestFinal_ex(digest.get(), sum.data(), &size) == 1;
  if (!good) throw FileError("cannot read '" + file.string() + "'; check its rights and the disk");
  return hexOf(sum.data(), size);
}

std::string textOf(const Checksums& checksums) {
  std::string text;
  for (const auto& [name, sum] : checksums) text += sum + "  " + name + "\n";
  return text;
}

Checksums readChecksums(const fs::path& file) {
  std::ifstream in(file);
  Checksums checksums;
  bool good = in.good();
  for (std::string line; good && std::getline(in, line);) {
    good = isEntry(line) && !in.eof();  // a line without its end was cut
    if (good) checksums[line.substr(kNameAt)] = line.substr(0, kDigits);
  }
  if (good && in.eof()) return checksums;
  throw FileError("'" + file.string() + "' is no list of checksums as edgevox writes it; map or " +
                  "save the run again, or delete the list if the files beside it are right");
}

}  // namespace edgevox

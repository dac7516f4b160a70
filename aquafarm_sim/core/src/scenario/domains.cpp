// SPDX-License-Identifier: BSD-3-Clause
#include "scenario/domains.h"

#include "base/text.h"
#include "base/time.h"

namespace aquafarm::internal {
namespace {

bool IsUtf8WithoutControls(const std::string& text) {
  std::size_t following = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (following > 0) {
      if ((byte & 0xC0U) != 0x80U) return false;
      --following;
    } else if (byte >= 0x80U) {
      following = byte >= 0xF0U ? 3 : byte >= 0xE0U ? 2 : 1;
      if (byte < 0xC2U || byte > 0xF4U) return false;
    } else if ((byte < 0x20U && c != '\n') || byte == 0x7FU) {
      return false;
    }
  }
  return following == 0;
}

}  // namespace

void Check(const std::string& path, std::int64_t seconds, UtcTime) {
  static const std::int64_t kFirst = *UtcSeconds(kFirstYear, 1, 1, 0, 0, 0);
  static const std::int64_t kLast = *UtcSeconds(kLastYear, 12, 31, 23, 59, 59);
  if (seconds >= kFirst && seconds <= kLast) return;
  throw FieldError(path, "got " + std::to_string(seconds) + " s since 1970, expected a year in [" +
                             Format(kFirstYear) + ", " + Format(kLastYear) + "]");
}

void Check(const std::string& path, float value, NumberOrNone) {
  if (std::isinf(value)) throw FieldError(path, "got infinity, expected a number or .nan");
}

void Check(const std::string& path, const std::string& value, const TextOf& domain) {
  if (value.size() < domain.min_bytes || value.size() > domain.max_bytes) {
    throw FieldError(path, "got a text of " + std::to_string(value.size()) + " bytes, expected [" +
                               std::to_string(domain.min_bytes) + ", " +
                               std::to_string(domain.max_bytes) + "]");
  }
  if (!IsUtf8WithoutControls(value)) {
    throw FieldError(path, "got control characters or invalid UTF-8, expected plain text");
  }
}

}  // namespace aquafarm::internal

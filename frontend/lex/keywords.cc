#include "frontend/lex/keywords.h"

#include <array>

#include "frontend/lex/characters.h"

namespace frontend {

namespace {

constexpr std::string_view kTexts[] = {
#define TOKEN(id, text) text,
#define KEYWORD(id, text) text,
#define SOFT(id, text) text,
#include "frontend/lex/tokens.def"
};
constexpr uint32_t kKindCount = sizeof kTexts / sizeof kTexts[0];
static_assert(kKindCount < 256, "a TokenKind is one byte");

constexpr uint32_t kSlots = 1024;
constexpr size_t kShortest = 2;
constexpr size_t kLongest = 18;  // END_FUNCTION_BLOCK

// Clearing bit 5 folds letters; other bytes may collide, the comparison decides.
constexpr uint32_t folded(char c) { return static_cast<uint8_t>(c) & 0xDFu; }

constexpr uint32_t slot_of(std::string_view name) {
  size_t n = name.size();
  uint32_t h = folded(name[0]) * 131 + folded(name[n - 1]) * 31 + folded(name[n / 2]) * 521 +
               folded(name[n - 2]) * 67 + static_cast<uint32_t>(n) * 257;
  return (h ^ (h >> 9)) % kSlots;
}

// Open addressing; 0 (kEnd, which is no keyword) marks a free slot.
constexpr std::array<uint8_t, kSlots> make_slots() {
  std::array<uint8_t, kSlots> slots{};
  for (uint32_t kind = static_cast<uint32_t>(kFirstKeyword); kind < kKindCount; ++kind) {
    uint32_t slot = slot_of(kTexts[kind]);
    while (slots[slot] != 0) slot = (slot + 1) % kSlots;
    slots[slot] = static_cast<uint8_t>(kind);
  }
  return slots;
}
constexpr std::array<uint8_t, kSlots> kSlotKinds = make_slots();

// Bit n: some keyword begins with that letter and has n characters. Most names fail here.
constexpr std::array<uint32_t, 32> make_lengths() {
  std::array<uint32_t, 32> lengths{};
  for (uint32_t kind = static_cast<uint32_t>(kFirstKeyword); kind < kKindCount; ++kind) {
    lengths[kTexts[kind][0] % 32] |= 1u << kTexts[kind].size();
  }
  return lengths;
}
constexpr std::array<uint32_t, 32> kLengths = make_lengths();

bool equals(std::string_view name, std::string_view upper) {
  if (name.size() != upper.size()) return false;
  for (size_t i = 0; i < name.size(); ++i) {
    if (to_upper(name[i]) != upper[i]) return false;
  }
  return true;
}

}  // namespace

std::string_view token_text(TokenKind kind) { return kTexts[static_cast<uint8_t>(kind)]; }

TokenKind keyword(std::string_view name) {
  if (name.size() < kShortest || name.size() > kLongest) return TokenKind::kName;
  // Letters without case are their low five bits; so is `_` (31) for __TRY.
  if ((kLengths[static_cast<uint8_t>(name[0]) % 32] >> name.size() & 1) == 0) {
    return TokenKind::kName;
  }
  uint32_t slot = slot_of(name);
  while (kSlotKinds[slot] != 0) {
    if (equals(name, kTexts[kSlotKinds[slot]])) return static_cast<TokenKind>(kSlotKinds[slot]);
    slot = (slot + 1) % kSlots;
  }
  return TokenKind::kName;
}

}  // namespace frontend

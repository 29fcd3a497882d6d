// The units of a project as people read them, for differences in words (X9): POUs with their
// variables and bodies, types, global variables, configurations, tests, and files that are no
// sources. Nothing is resolved: a unit is what the sources say.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "frontend/network/network.h"
#include "tools/stc/project.h"

namespace stc {

// Kinds of units that are files: settings, a document that was imported, a source.
inline constexpr const char* kSettingsUnit = "settings";
inline constexpr const char* kDocumentUnit = "document";
inline constexpr const char* kSourceUnit = "source";

// A variable, a field, a step, a task: what has a name, and one text.
struct UnitPart {
  std::string kind;
  std::string name;
  std::string text;  // without comments, in one line
};

struct BodyLine {
  std::string text;
  uint32_t number = 0;  // in its file
};
enum class BodyKind : uint8_t { kText, kLadder, kFbd };
struct UnitBody {
  std::string name;  // "" of the unit itself; "action Fill" of a chart
  BodyKind kind = BodyKind::kText;
  std::vector<BodyLine> lines;           // kText
  frontend::network::Body diagram = {};  // else
};

struct Unit {
  std::string kind;  // "FUNCTION_BLOCK", "TYPE", "VAR_GLOBAL", ...
  std::string name;  // "Motor.Start"
  std::string file;  // from the folder of the project
  uint32_t line = 0;
  std::vector<UnitPart> parts;
  std::vector<UnitBody> bodies;
  std::string tokens;    // all of it, but for comments, layout, the case of names, and drawings
  std::string comments;  // all of them
  std::string text;      // as it stands there
};

// In source order.
std::vector<Unit> units_of(const Project& project);

// What two texts have in common that differ in layout and comments only.
std::string tokens_of(std::string_view text);
std::string comments_of(std::string_view text);

}  // namespace stc

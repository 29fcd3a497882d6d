// Text exports (.EXP) of CODESYS V2.3 and TwinCAT 2 -> sources. An export is a list of objects:
// POUs with the actions behind them, types, lists of global variables. Declarations and bodies in
// ST and IL are text; ladder and function block diagrams are trees, a word or an operand in each
// line (networks.h). No vendor describes the form: what is read is what published exports and the
// programs that write them show. What is not known is an error (E1083) or a warning (W0070).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "adapters/text_export/pins.h"
#include "adapters/xml/imported.h"
#include "base/source.h"

namespace text_export {

// A piece of the text of an export.
struct Part {
  uint32_t begin = 0;
  uint32_t end = 0;
};

struct Action {
  std::string name;
  Part body;
};

enum class Kind : uint8_t { kPou, kType, kGlobals };

struct Object {
  Kind kind = Kind::kPou;
  std::string word;    // of POUs: PROGRAM, FUNCTION_BLOCK or FUNCTION
  std::string name;    // may be none of Structured Text
  bool nested = true;  // comments in its text nest
  Part declaration;
  Part body;
  std::vector<Action> actions;
};

// What the objects of an export are not.
struct Remark {
  base::DiagnosticCode code;
  bool foreign = false;  // a part that no source has: a list of libraries, a configuration
  Part place;
  std::string text;
  std::string fix;
};

// Views of the text, which has to outlive it.
struct Export {
  std::string_view text;
  base::SourcePos begin;  // of the text in its SourceMap
  std::vector<Object> objects;
  std::vector<Remark> remarks;

  std::string_view of(Part part) const { return text.substr(part.begin, part.end - part.begin); }
};

// `text` is UTF-8 and stands at `begin` of a SourceMap.
Export split(std::string_view text, base::SourcePos begin);

// Is there what no source holds: drawings, parts of the editor, comments that do not nest? Else it
// is a source as it stands, whatever else is in it.
bool is_more_than_text(const Export& of);

// What its function blocks call their pins.
void add_pins(const Export& from, PinNames& pins);

// `pins`: of all exports that are imported together, and of the library.
void import(const Export& from, const PinNames& pins, xml::Imported& out);

}  // namespace text_export

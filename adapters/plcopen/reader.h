// Inside of the import: pieces of PLCopen XML as pieces of text. Each returns text that stands for
// itself, ended by a newline where it is lines; empty where there is nothing or, after a report,
// where nothing could be understood.
#pragma once

#include <set>
#include <string>

#include "adapters/xml/chart_attributes.h"
#include "adapters/xml/document.h"
#include "adapters/xml/operand.h"

namespace plcopen {

using xml::Code;
using xml::is_operand;
using xml::is_plain_operand;
using xml::Node;
using xml::Reporter;

inline constexpr const char* kIndent = "  ";

// --- configuration.cc
// What `element` declares: a source of its own under that name, or in the place where it was
// exported from. Returns the name of the source.
std::string add_declaration(Node element, std::string_view name, std::string text,
                            Reporter& report);

// --- types.cc
std::string type_text(Node type, Reporter& report);       // <type>, <baseType>: ARRAY[1..5] OF INT
std::string data_type(Node data_type, Reporter& report);  // <dataType>: TYPE ... END_TYPE
std::string union_type(Node node, Reporter& report);      // <union> of CODESYS, likewise

// --- values.cc
std::string value_text(Node value, Reporter& report);  // <initialValue>: [1, 2(0)]

// --- variables.cc
// All lists of <interface>, <resource> or <configuration>, in order, but those that have a name.
std::string variable_lists(Node parent, Reporter& report);
std::string variable_list(Node list, Reporter& report);
// What lists of global variables with a name declare is found by it: GVL.x.
bool is_named_list(Node list);
std::string documentation(Node owner, std::string_view indent);

// --- vendor.cc
// What vendors say in the addData of a POU, method or variable.
struct Vendor {
  std::string attributes;   // {attribute 'x' := 'y'} lines
  std::string declaration;  // the interface as text, with its head or without
  std::string access;       // "PRIVATE "
  std::string extends;      // " EXTENDS A"
  std::string implements;   // " IMPLEMENTS B, C"
  Node mixed;  // lists of variables with different qualifiers, in place of the one around them
  std::vector<Node> methods;
  std::vector<Node> properties;
};
Vendor vendor_data(Node owner, Reporter& report);
// What people have excluded from the build does not come in: a note.
bool is_excluded(Node owner, Reporter& report);
// A <data> that nothing takes: a note when it is known to be of an editor, else a warning.
void report_data(Node data, Reporter& report);
std::vector<Node> vendor_parts(Node owner);        // its <data>, with those of its <interface>
std::string attribute_lines(Node data);            // {attribute 'x' := 'y'} of each
bool is_vendor(Node data, std::string_view name);  // last part of its name, in any case

// --- pou.cc
void import_pou(Node pou, Reporter& report);
void import_interface(Node interface, Reporter& report);

// --- body.cc
// The bodies of `owner` (<pou>, <action> ...) as text. `name` says whose in messages.
std::string body_text(Node owner, const std::string& name, Reporter& report);
// The same for the element that holds <ST>, <IL>, <LD>, <FBD> or <SFC>.
std::string language_text(Node body, Node owner, const std::string& name, Reporter& report);
// Statements in the place of a body that could not be imported: nothing takes it for empty.
std::string error_text(const std::string& text);
// A condition after FROM ... TO ...: `:= expression;`, or an instruction list after a colon.
// `name` is that of the transition, to which a body may assign its value; it may be empty.
std::string condition_text(Node body, const std::string& name, Reporter& report);
// Its text where it is more than an expression: statements in ST that give `name` a value.
std::string statements_of_condition(Node body, const std::string& name);

// --- action.cc
// `Fill(D, T#2s);` as it stands in a step.
std::string action_use(Node action, const std::string& name, Reporter& report);
// negated="true", of a condition or action block.
bool is_negated(Node node, Reporter& report);

// --- chart.cc
std::string chart_text(Node sfc, Node pou, Reporter& report);
// --- chart_data.cc
// What CODESYS keeps beside an element of a chart; null: nothing is reported.
xml::ChartAttributes chart_attributes(Node element, Reporter* report);
// Of all steps of the charts in `pou`.
xml::OwnActions own_actions(Node pou);
// Does one of the steps have attributes of CODESYS?
bool is_chart_of_codesys(Node pou);
bool is_chart_data(Node data);

// --- kept.cc
// The declaration that `node` stands in, for what an export puts there again: the same for elements
// that are read and for those that are written. Empty: the project.
std::string place_of(Node node);
// <data> of an editor goes out where it was, if that is a declaration itself.
void keep_editor_data(Node data, Reporter& report);
// `node` with everything in it as text that needs no declarations around it.
std::string plain_xml(Node node);
// For an export: `text` was made of it, with `members` that stand in steps and conditions.
void keep_chart(Node sfc, Node pou, const std::string& text, std::set<std::string> members,
                Reporter& report);

// --- configuration.cc
void import_configuration(Node configuration, Reporter& report);
void import_resource(Node resource, Reporter& report);  // that stands in no configuration

}  // namespace plcopen

#include <algorithm>

#include "adapters/plcopen/reader.h"
#include "base/name_case.h"
#include "ir/types/types.h"

namespace plcopen {
namespace {

constexpr const char* kElementaryTags[] = {
    "BOOL",          "BYTE",        "WORD",          "DWORD",   "LWORD",       "SINT",
    "INT",           "DINT",        "LINT",          "USINT",   "UINT",        "UDINT",
    "ULINT",         "REAL",        "LREAL",         "TIME",    "LTIME",       "DATE",
    "LDATE",         "TOD",         "LTOD",          "DT",      "LDT",         "CHAR",
    "WCHAR",         "TIME_OF_DAY", "DATE_AND_TIME", "ANY",     "ANY_DERIVED", "ANY_ELEMENTARY",
    "ANY_MAGNITUDE", "ANY_NUM",     "ANY_REAL",      "ANY_INT", "ANY_BIT",     "ANY_STRING",
    "ANY_DATE"};

// What a type or bound is written with; no statement can hide in it.
bool is_simple(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(),
                     [](char c) {
                       return xml::is_name(std::string_view(&c, 1)) || (c >= '0' && c <= '9') ||
                              std::string_view(" .,#()[]+-*/:='\"%&<>^$").find(c) !=
                                  std::string_view::npos;
                     }) &&
         text.find("(*") == std::string_view::npos && text.find("//") == std::string_view::npos;
}

std::string simple(Node node, std::string_view text, Reporter& report) {
  text = xml::trimmed(text);
  if (is_simple(text)) return std::string(text);
  report.add(Code::kXmlBadValue, node,
             "`" + std::string(text) + "` in " + xml::shown(node) + " is no type or bound");
  return {};
}

std::string range(Node node, Reporter& report) {
  if (xml::attribute(node, "lower") == "*") return "*";  // ARRAY[*]
  std::string low = simple(node, report.required(node, "lower"), report);
  std::string high = simple(node, report.required(node, "upper"), report);
  return low + ".." + high;
}

std::string string_text(Node node, const char* word, Reporter& report) {
  std::string_view length = xml::attribute(node, "length");
  if (length.empty()) return word;
  return word + std::string("[") + simple(node, length, report) + "]";
}

std::string array_text(Node node, Reporter& report) {
  std::string dimensions;
  for (Node dimension : xml::children(node, "dimension")) {
    dimensions += (dimensions.empty() ? "" : ", ") + range(dimension, report);
  }
  if (dimensions.empty()) report.add(Code::kXmlMissing, node, "<array> has no <dimension>");
  return "ARRAY[" + dimensions + "] OF " + type_text(xml::child(node, "baseType"), report);
}

std::string subrange_text(Node node, Reporter& report) {
  Node bounds = xml::child(node, "range");
  if (!bounds) report.add(Code::kXmlMissing, node, xml::shown(node) + " has no <range>");
  return type_text(xml::child(node, "baseType"), report) + " (" + range(bounds, report) + ")";
}

std::string enum_text(Node node, Reporter& report) {
  std::string values;
  for (Node value : xml::children(xml::child(node, "values"), "value")) {
    values += (values.empty() ? "" : ", ") + std::string(report.required_name(value));
    std::string_view number = xml::attribute(value, "value");
    if (!number.empty()) values += " := " + simple(value, number, report);
  }
  if (values.empty()) report.add(Code::kXmlMissing, node, "<enum> has no <values>");
  std::string base = xml::child(node, "baseType")
                         ? " " + type_text(xml::child(node, "baseType"), report)
                         : std::string();
  return "(" + values + ")" + base;
}

// `word`: STRUCT or UNION.
std::string members_text(Node node, const std::string& word, Reporter& report) {
  std::string out = word + "\n";
  for (Node member : xml::children(node, "variable")) {
    std::string address(xml::attribute(member, "address"));
    std::string name(report.required_name(member));
    if (name.empty()) continue;
    out += xml::indented(vendor_data(member, report).attributes, kIndent);
    out += kIndent + name + (address.empty() ? "" : " AT " + address) + " : " +
           type_text(xml::child(member, "type"), report);
    std::string value = value_text(xml::child(member, "initialValue"), report);
    if (!value.empty()) out += " := " + value;
    out += ";";
    std::string note = documentation(member, " ");
    out += note.empty() ? "\n" : note;
  }
  return out + "END_" + word;
}

}  // namespace

std::string type_text(Node type, Reporter& report) {
  Node node = xml::first_element(type);
  if (!node) {
    report.add(Code::kXmlMissing, type ? type : report.document().root(),
               type ? "<" + std::string(xml::local_name(type)) + "> is empty"
                    : std::string("a type is missing"));
    return {};
  }
  const std::string_view kind = xml::local_name(node);
  for (const char* name : kElementaryTags) {
    if (base::same_name(kind, name)) return name;
  }
  if (base::same_name(kind, "string")) return string_text(node, "STRING", report);
  if (base::same_name(kind, "wstring")) return string_text(node, "WSTRING", report);
  if (kind == "derived") return simple(node, report.required(node, "name"), report);
  if (kind == "array") return array_text(node, report);
  if (kind == "enum") return enum_text(node, report);
  if (kind == "struct") return members_text(node, "STRUCT", report);
  if (kind == "subrangeSigned" || kind == "subrangeUnsigned") return subrange_text(node, report);
  if (kind == "pointer") return "POINTER TO " + type_text(xml::child(node, "baseType"), report);
  if (kind == "reference") return "REFERENCE TO " + type_text(xml::child(node, "baseType"), report);
  report.add(Code::kXmlBadValue, node, xml::shown(node) + " is no type");
  return {};
}

std::string union_type(Node node, Reporter& report) {
  const std::string name(report.required_name(node));
  if (name.empty()) return {};
  const Vendor vendor = vendor_data(node, report);
  const std::string note = documentation(node, "");
  if (!vendor.declaration.empty()) return note + vendor.declaration;
  return note + vendor.attributes + "TYPE " + name + " : " + members_text(node, "UNION", report) +
         ";\nEND_TYPE\n";
}

std::string data_type(Node node, Reporter& report) {
  const std::string name(report.required_name(node));
  if (name.empty()) return {};
  Vendor vendor = vendor_data(node, report);
  const std::string note = documentation(node, "");
  if (!vendor.declaration.empty()) return note + vendor.declaration;
  Node type = xml::child(node, "baseType");
  std::string text = type_text(type, report);
  std::string value = value_text(xml::child(node, "initialValue"), report);
  if (!value.empty()) text += " := " + value;
  return note + vendor.attributes + "TYPE " + name + " : " + text + ";\nEND_TYPE\n";
}

}  // namespace plcopen

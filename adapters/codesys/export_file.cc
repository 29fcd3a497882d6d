#include "adapters/codesys/export_file.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "base/limits.h"
#include "base/name_case.h"

namespace codesys {
namespace {

using xml::Code;
using xml::Node;

enum class Kind : uint8_t {
  kPou,
  kInterface,
  kMethod,
  kProperty,
  kAccessor,
  kAction,
  kTransition,
  kType,
  kGlobals,
  kFolder,
  kTask,
  kEditor,  // has no meaning here
  kUnknown,
};

struct Row {
  const char* guid;
  Kind kind;
  const char* element;  // of objects of TwinCAT
};

constexpr Row kRows[] = {
    {"6f9dac99-8de1-4efc-8465-68ac443b7d08", Kind::kPou, "POU"},
    {"6654496c-404d-479a-aad2-8551054e5f1e", Kind::kInterface, "Itf"},
    {"f8a58466-d7f6-439f-bbb8-d4600e41d099", Kind::kMethod, "Method"},
    {"f89f7675-27f1-46b3-8abb-b7da8e774ffd", Kind::kMethod, "Method"},  // of interfaces
    {"62ebfd1c-d342-43e5-8efb-f22b6d8e4a04", Kind::kMethod, "Method"},
    {"5a3b8626-d3e9-4f37-98b5-66420063d91e", Kind::kProperty, "Property"},
    {"792f2eb6-721e-4e64-ba20-bc98351056db", Kind::kAccessor, ""},  // Get or Set, by its name
    {"8ac092e5-3128-4e26-9e7e-11016c6684f2", Kind::kAction, "Action"},
    {"a10c6218-cb94-436f-91c6-e1652575253d", Kind::kTransition, "Transition"},
    {"2db5746d-d284-4425-9f7f-2663a34b0ebc", Kind::kType, "DUT"},
    {"40989022-e4d2-4dc7-89d2-9a412930b20e", Kind::kType, "DUT"},  // enumerations
    {"ffbfa93a-b94d-45fc-a329-229860183b1d", Kind::kGlobals, "GVL"},
    {"261bd6e6-249c-4232-bb6f-84c2fbeef430", Kind::kGlobals, "GVL"},  // persistent ones
    {"f89f7675-27f3-455b-b98a-243e8673a5a8", Kind::kGlobals, "GVL"},  // parameters of a library
    {"738bea1e-99bb-4f04-90bb-a7a567e74e3a", Kind::kFolder, ""},
    {"98a2708a-9b18-4f31-82ed-a1465b24fa2d", Kind::kTask, ""},
    {"413e2a7d-adb1-4d2c-be29-6ae6e4fab820", Kind::kTask, ""},    // a call of a task
    {"ae1de277-a207-4a28-9efb-456c06bd52f3", Kind::kEditor, ""},  // the list of tasks
    {"225bfe47-7336-4dbc-9419-4105a7c831fa", Kind::kEditor, ""},  // a device
    {"40b404f9-e5dc-42c6-907f-c89f4a517386", Kind::kEditor, ""},  // its logic
    {"639b491f-5557-464c-af91-1471bac9f549", Kind::kEditor, ""},  // the application in that
    {"085afe48-c5d8-4ea5-ab0d-b35701fa6009", Kind::kEditor, ""},  // information on the project
    {"8753fe6f-4a22-4320-8103-e553c4fc8e04", Kind::kEditor, ""},  // settings of it
};

constexpr Row kUnknownRow = {"", Kind::kUnknown, ""};

// <Single Name="NAME">; a <Null Name="NAME"> is none.
Node member(Node owner, std::string_view name) {
  for (Node child : xml::children(owner)) {
    if (xml::attribute(child, "Name") == name && !xml::is(child, "Null")) return child;
  }
  return {};
}

std::string value(Node owner, std::string_view name) {
  return std::string(xml::trimmed(member(owner, name).child_value()));
}

// A GUID without braces, in lower case.
std::string guid(Node owner, std::string_view name) {
  std::string out = base::fold_name(value(owner, name));
  std::erase(out, '{');
  std::erase(out, '}');
  return out;
}

// Nothing but text.
bool add_text(Node node, std::string& out) {
  for (Node piece : node.children()) {
    if (piece.type() != pugi::node_pcdata && piece.type() != pugi::node_cdata) return false;
    out += piece.value();
  }
  return bool(node);
}

// <Single Name="Interface"> or "Implementation": its text as one, or, in older files, by rows.
// false: it is no text.
bool text_of(Node part, std::string& out) {
  const Node document = member(part, "TextDocument");
  if (const Node blob = member(document, "TextBlobForSerialisation")) return add_text(blob, out);
  const Node rows = member(document, "TextLines");
  if (!rows) return false;
  for (Node row : xml::children(rows)) {
    if (!add_text(member(row, "Text"), out)) return false;
    out += '\n';
  }
  return true;
}

// What people have ticked: one of the properties of an object, each of which has a GUID as its key.
bool is_excluded(Node meta) {
  const Node property = member(meta, "Properties").find_node([](Node node) {
    return xml::attribute(node, "Name") == "ExcludeFromBuild";
  });
  return xml::boolean(base::fold_name(xml::trimmed(property.child_value()))).value_or(false);
}

struct Entry {
  Node node;
  Node object;
  std::string name;
  std::string parent;
  const Row* row = &kUnknownRow;
  std::vector<uint32_t> children;  // below folders, too
  bool written = false;
  bool orphan = false;    // its owner is not there, which has been said
  bool excluded = false;  // from the build, or what it stands in is
};

class Reader {
 public:
  Reader(xml::Reporter& report, Objects& out) : report_(report), out_(out) {}
  void run(Node root);

 private:
  void find_entries(Node root);
  void add(Node meta, Node object, Node node);
  void find_excluded();
  void find_children();
  uint32_t owner_of(uint32_t entry) const;
  void write(uint32_t entry, Node parent, bool has_bodies);
  Node element(Node parent, const char* name, const Entry& entry);
  void texts(Node to, const Entry& entry, bool needs_body);
  void left_out(const Entry& entry);

  static constexpr uint32_t kNone = 0xffffffffu;

  xml::Reporter& report_;
  Objects& out_;
  std::vector<Entry> entries_;
  std::map<std::string, uint32_t> by_guid_;
};

void Reader::add(Node meta, Node object, Node node) {
  Entry entry;
  entry.node = node;
  entry.object = object;
  entry.name = value(meta, "Name");
  entry.parent = guid(meta, "ParentGuid");
  entry.excluded = is_excluded(meta);
  const std::string type = guid(meta, "TypeGuid");
  for (const Row& row : kRows) {
    if (type == row.guid) entry.row = &row;
  }
  const auto number = static_cast<uint32_t>(entries_.size());
  if (!by_guid_.emplace(guid(meta, "Guid"), number).second) {
    report_.add(Code::kXmlDoubleId, node, "two objects have the number of `" + entry.name + "`");
  }
  entries_.push_back(std::move(entry));
}

// Wherever they stand: an entry is what has a MetaObject.
void Reader::find_entries(Node root) {
  struct Finder : pugi::xml_tree_walker {
    explicit Finder(Reader& wanted) : reader(wanted) {}
    bool for_each(Node& node) override {
      const Node meta = xml::is(node, "Single") ? member(node, "MetaObject") : Node();
      if (meta) reader.add(meta, member(node, "Object"), node);
      return true;
    }
    Reader& reader;
  } finder(*this);
  root.traverse(finder);
}

// The POU, interface or, of accessors, property that an entry belongs to; folders are looked
// through.
uint32_t Reader::owner_of(uint32_t entry) const {
  const bool accessor = entries_[entry].row->kind == Kind::kAccessor;
  for (uint32_t steps = 0; steps < base::kMaxXmlDepth; ++steps) {
    const auto found = by_guid_.find(entries_[entry].parent);
    if (found == by_guid_.end() || found->second == entry) return kNone;
    entry = found->second;
    const Kind kind = entries_[entry].row->kind;
    const bool owns =
        accessor ? kind == Kind::kProperty : kind == Kind::kPou || kind == Kind::kInterface;
    if (owns) return entry;
    if (kind != Kind::kFolder) return kNone;
  }
  return kNone;
}

// Of what is excluded, so is all that stands in it.
void Reader::find_excluded() {
  for (Entry& entry : entries_) {
    const Entry* outer = &entry;
    for (uint32_t steps = 0; steps < base::kMaxXmlDepth && !entry.excluded; ++steps) {
      const auto found = by_guid_.find(outer->parent);
      if (found == by_guid_.end()) break;
      outer = &entries_[found->second];
      entry.excluded = outer->excluded;
    }
    if (!entry.excluded) continue;
    report_.add(Code::kXmlLeftOut, entry.node, "`" + entry.name + "` is excluded from the build");
  }
}

void Reader::find_children() {
  for (uint32_t i = 0; i < entries_.size(); ++i) {
    const Kind kind = entries_[i].row->kind;
    const bool member = kind >= Kind::kMethod && kind <= Kind::kTransition;
    if (!member || entries_[i].excluded) continue;
    const uint32_t owner = owner_of(i);
    entries_[i].orphan = owner == kNone;
    if (owner == kNone) {
      report_.add(Code::kXmlMissing, entries_[i].node,
                  "`" + entries_[i].name + "` belongs to an object that is not in this file",
                  "export the whole POU");
    } else {
      entries_[owner].children.push_back(i);
    }
  }
}

Node Reader::element(Node parent, const char* name, const Entry& entry) {
  Node out = parent.append_child(name);
  out.append_attribute("Name") = entry.name.c_str();
  out_.origins.emplace(out.internal_object(), entry.node);
  return out;
}

// `needs_body`: without one it is not whole.
void Reader::texts(Node to, const Entry& entry, bool needs_body) {
  std::string declaration;
  if (const Node part = member(entry.object, "Interface"); text_of(part, declaration)) {
    to.append_child("Declaration").append_child(pugi::node_cdata).set_value(declaration.c_str());
  }
  const Node part = member(entry.object, "Implementation");
  if (!part) {
    if (!needs_body) return;
    report_.add(Code::kXmlMissing, entry.node, "`" + entry.name + "` has no body",
                "export it again");
    return;
  }
  Node body = to.append_child("Implementation");
  std::string statements;
  if (text_of(part, statements)) {
    body.append_child("ST").append_child(pugi::node_cdata).set_value(statements.c_str());
  } else {
    body.append_child("Drawing");
  }
}

// `has_bodies`: it is no interface, nor in one. At most three levels, since owner_of() is strict.
void Reader::write(uint32_t number, Node parent, bool has_bodies) {
  Entry& entry = entries_[number];
  entry.written = true;
  const Kind kind = entry.row->kind;
  const char* name = entry.row->element;
  if (kind == Kind::kAccessor) name = base::same_name(entry.name, "Set") ? "Set" : "Get";
  const Node out = element(parent, name, entry);
  const bool executes = kind == Kind::kPou || kind == Kind::kMethod || kind == Kind::kAccessor ||
                        kind == Kind::kAction || kind == Kind::kTransition;
  texts(out, entry, executes && has_bodies);
  for (uint32_t child : entry.children) write(child, out, has_bodies);
}

void Reader::left_out(const Entry& entry) {
  const std::string what = "`" + entry.name + "`";
  if (entry.row->kind == Kind::kFolder || entry.row->kind == Kind::kEditor) {
    report_.add(Code::kXmlLeftOut, entry.node, what + " is of the editor or of its devices only");
  } else if (entry.row->kind == Kind::kTask) {
    report_.add(Code::kXmlNotUnderstood, entry.node, what + " belongs to a task, which is not read",
                "declare the task in a CONFIGURATION");
  } else {
    report_.add(Code::kXmlNotUnderstood, entry.node,
                what + " is an object of a kind that is not known here");
  }
}

void Reader::run(Node root) {
  find_entries(root);
  find_excluded();
  find_children();
  Node all = out_.document.append_child("TcPlcObject");
  out_.origins.emplace(all.internal_object(), root);
  for (uint32_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].excluded) continue;
    const Kind kind = entries_[i].row->kind;
    const bool top = kind == Kind::kPou || kind == Kind::kInterface || kind == Kind::kType ||
                     kind == Kind::kGlobals;
    if (top) {
      write(i, all, kind != Kind::kInterface);
    } else if (kind >= Kind::kFolder) {
      left_out(entries_[i]);
    }
  }
  for (const Entry& entry : entries_) {
    if (entry.written || entry.row->kind >= Kind::kFolder) continue;
    if (entry.orphan || entry.excluded) continue;
    report_.add(Code::kXmlMissing, entry.node,
                "`" + entry.name + "` belongs to an object that does not come in");
  }
}

}  // namespace

bool is_export(const xml::Document& document) { return xml::is(document.root(), "ExportFile"); }

void read_objects(const xml::Document& document, xml::Reporter& report, Objects& out) {
  Reader(report, out).run(document.root());
}

}  // namespace codesys

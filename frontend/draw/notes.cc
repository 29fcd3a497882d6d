#include "frontend/draw/notes.h"

#include <algorithm>

#include "frontend/questions/documentation.h"
#include "ir/types/address_text.h"
#include "ir/types/types.h"

namespace frontend::draw {

void Notes::set(std::string_view name, Note note) {
  if (!note.empty()) notes_[ir::fold_name(name)] = std::move(note);
}

const Note* Notes::find(std::string_view operand) const {
  if (operand.starts_with('.')) operand.remove_prefix(1);  // .x is the global
  const auto found = notes_.find(ir::fold_name(operand));
  return found == notes_.end() ? nullptr : &found->second;
}

namespace {

class Collector {
 public:
  explicit Collector(const base::SourceMap& sources) : sources_(sources) {}

  void add(const std::vector<VarBlock>& blocks, bool global) {
    for (const VarBlock& block : blocks) {
      const bool declares = block.section != VarSection::kExternal &&
                            block.section != VarSection::kAccess &&
                            block.section != VarSection::kConfig;
      if (!declares) continue;
      for (const VarDecl& variable : block.vars) add(variable, global);
    }
  }
  Notes take() { return std::move(notes_); }

 private:
  void add(const VarDecl& variable, bool global) {
    for (const Name& name : variable.names) {
      if (!name.span.begin.valid()) continue;  // made by a chart
      Note note{address(variable), comment(name.span.begin)};
      if (global) notes_.set(list(name.span.begin) + '.' + std::string(name.text), note);
      notes_.set(name.text, std::move(note));
    }
  }

  static std::string address(const VarDecl& variable) {
    return variable.has_address && !variable.incomplete && variable.levels.count == 0
               ? ir::address_text(variable.address)
               : "";
  }

  // As sema names a list of globals: by its file.
  std::string list(base::SourcePos at) const {
    std::string_view file = sources_.locate(at).file;
    file.remove_prefix(file.find_last_of("/\\") + 1);
    return std::string(file.substr(0, file.find('.')));
  }

  std::string comment(base::SourcePos at) {
    const uint32_t file = sources_.file_of(at);
    const std::string_view text = sources_.text(file);
    const auto known = documented_.try_emplace(file, text).first;
    std::string out = known->second.at(at.offset - sources_.begin(file).offset, false);
    std::replace(out.begin(), out.end(), '\n', ' ');
    return out;
  }

  const base::SourceMap& sources_;
  std::unordered_map<uint32_t, questions::Documentation> documented_;
  Notes notes_;
};

}  // namespace

Notes notes_of(const Tree& tree, const base::SourceMap& sources, const PouDecl& pou,
               const PouDecl* owner) {
  Collector out(sources);
  out.add(tree.globals, true);
  for (const ConfigDecl& config : tree.configs) {
    out.add(config.globals, true);
    for (const ResourceDecl& resource : config.resources) out.add(resource.globals, true);
  }
  if (owner != nullptr) out.add(owner->blocks, false);
  out.add(pou.blocks, false);
  return out.take();
}

}  // namespace frontend::draw

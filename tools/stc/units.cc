#include "tools/stc/units.h"

#include <algorithm>

#include "frontend/compile.h"
#include "frontend/parse/tree.h"
#include "tools/stc/project_folder.h"
#include "tools/stc/unit_slices.h"

namespace stc {
namespace {

using frontend::PouDecl;

const char* pou_word(frontend::PouKind kind) {
  static constexpr const char* kWords[] = {
      "FUNCTION",     "FUNCTION_BLOCK", "PROGRAM", "CLASS", "INTERFACE", "METHOD",       "ACTION",
      "PROPERTY GET", "PROPERTY SET",   "TEST",    "SETUP", "TEARDOWN",  "MOCK_FUNCTION"};
  return kWords[static_cast<size_t>(kind)];
}

class Units {
 public:
  Units(const base::SourceMap& sources, const frontend::Tree& tree, const ProjectFolder& folder)
      : slices_(sources), tree_(tree), folder_(folder) {}

  std::vector<Unit> run() {
    for (const frontend::TypeDecl& type : tree_.types) add_type(type);
    for (const PouDecl& pou : tree_.pous) add_pou(pou, namespace_of(pou.scope));
    for (const PouDecl& test : tree_.tests) add_pou(test, namespace_of(test.scope));
    add_globals();
    for (const frontend::ConfigDecl& config : tree_.configs) add_config(config);
    return std::move(units_);
  }

 private:
  std::string namespace_of(frontend::ScopeId scope) const {
    std::string out;
    for (; scope.valid(); scope = tree_[scope].parent) {
      if (!tree_[scope].name.empty()) out = std::string(tree_[scope].name.text) + "." + out;
    }
    return out;
  }

  Unit begin_unit(std::string kind, std::string name, base::SourceSpan span) const {
    Unit unit;
    unit.kind = std::move(kind);
    unit.name = std::move(name);
    unit.file = folder_.path_of(std::string(slices_.file(span.begin)));
    unit.line = slices_.line(span.begin);
    return unit;
  }
  void end_unit(Unit unit, std::string text) {
    unit.tokens = tokens_of(text);
    unit.comments = comments_of(text);
    unit.text = std::move(text);
    units_.push_back(std::move(unit));
  }

  std::string attributes_text(frontend::Range32 of) const {
    std::string out;
    for (uint32_t i = 0; i < of.count; ++i) {
      const frontend::Attribute& attribute = tree_.attributes[of.first + i];
      out += " {" + std::string(attribute.name.text);
      if (attribute.has_value) out += " := '" + std::string(attribute.value) + "'";
      out += "}";
    }
    return out;
  }

  void add_variables(Unit& unit, const frontend::VarBlock& block, const std::string& prefix) const {
    const std::string section = section_text(block) + attributes_text(block.attributes);
    for (const frontend::VarDecl& variable : block.vars) {
      if (variable.implied) continue;
      const std::string attributes = attributes_text(variable.attributes);
      if (variable.names.empty()) {
        const std::string whole = slices_.plain(variable.span);
        unit.parts.push_back({"variable", prefix + whole.substr(0, whole.find_first_of(" :")),
                              section + " " + whole + attributes});
        continue;
      }
      const base::SourceSpan rest{variable.names[variable.names.size() - 1].span.end,
                                  variable.span.end};
      for (const frontend::Name& name : variable.names) {
        unit.parts.push_back({"variable", prefix + std::string(name.text),
                              section + " " + std::string(name.text) + " " + slices_.plain(rest) +
                                  attributes});
      }
    }
  }

  void add_type(const frontend::TypeDecl& type) {
    const frontend::Spec& spec = tree_[type.spec];
    const base::SourceSpan span{type.name.span.begin, spec.span.end};
    Unit unit = begin_unit("TYPE", namespace_of(type.scope) + std::string(type.name.text), span);
    for (const frontend::VarDecl& field : spec.fields) {
      for (const frontend::Name& name : field.names) {
        const base::SourceSpan rest{field.names[field.names.size() - 1].span.end, field.span.end};
        unit.parts.push_back({"field", std::string(name.text),
                              std::string(name.text) + " " + slices_.plain(rest) +
                                  attributes_text(field.attributes)});
      }
    }
    for (const frontend::Enumerator& value : spec.enumerators) {
      std::string text(value.name.text);
      if (value.value.valid()) text += " := " + slices_.plain(tree_[value.value].span);
      unit.parts.push_back({"value", std::string(value.name.text), std::move(text)});
    }
    const bool listed = !unit.parts.empty();
    std::string rest = listed ? std::string() : slices_.plain(spec.span);
    if (spec.element.valid() && listed) rest = slices_.plain(tree_[spec.element].span);
    if (type.init.valid()) rest += " := " + slices_.plain(tree_[type.init].span);
    rest += attributes_text(type.attributes);
    if (!rest.empty()) unit.parts.push_back({"declaration", "", std::move(rest)});
    end_unit(std::move(unit), std::string(slices_.of(span)));
  }

  base::SourcePos head_end(const PouDecl& pou) const {
    base::SourcePos end = pou.name.empty() ? pou.span.begin : pou.name.span.end;
    const auto reach = [&](frontend::SpecId id) {
      if (id.valid()) end = std::max(end, tree_[id].span.end);
    };
    reach(pou.result);
    for (const frontend::SpecId id : pou.extends) reach(id);
    for (const frontend::SpecId id : pou.implements) reach(id);
    return end;
  }

  void add_pou(const PouDecl& pou, const std::string& prefix) {
    const std::string name = prefix + std::string(pou.name.text);
    Unit unit = begin_unit(pou_word(pou.kind), name, pou.span);
    base::SourcePos body = head_end(pou);
    unit.parts.push_back({"declaration", "",
                          slices_.plain({pou.span.begin, body}) + attributes_text(pou.attributes)});
    for (const frontend::VarBlock& block : pou.blocks) {
      add_variables(unit, block, "");
      body = std::max(body, slices_.whole(block).end);
    }
    const std::vector<base::SourceSpan> own = without_members(pou);
    if (pou.chart != frontend::kNoChart) {
      add_chart(unit, tree_.charts[pou.chart]);
    } else if (pou.diagram != frontend::kNoDiagram) {
      add_diagram(unit, "", pou.diagram);
    } else {
      unit.bodies.push_back({"", BodyKind::kText, body_lines(own, body)});
    }
    std::string text;
    for (const base::SourceSpan& piece : own) {
      const std::string_view trimmed = Slices::trimmed(slices_.of(piece));
      if (!trimmed.empty()) text += std::string(trimmed) + "\n";
    }
    end_unit(std::move(unit), std::move(text));
    for (const PouDecl& member : pou.members) add_pou(member, name + ".");
  }

  static std::vector<base::SourceSpan> without_members(const PouDecl& pou) {
    std::vector<base::SourceSpan> out;
    base::SourcePos at = pou.span.begin;
    for (const PouDecl& member : pou.members) {
      if (member.span.begin < at) continue;
      out.push_back({at, member.span.begin});
      at = member.span.end;
    }
    out.push_back({at, pou.span.end});
    return out;
  }

  // After `begin`, without the word at the end.
  std::vector<BodyLine> body_lines(const std::vector<base::SourceSpan>& own,
                                   base::SourcePos begin) const {
    std::vector<BodyLine> out;
    for (base::SourceSpan piece : own) {
      piece.begin = std::max(piece.begin, begin);
      if (piece.end <= piece.begin) continue;
      for (BodyLine& line : slices_.lines(piece)) {
        if (!line.text.empty()) out.push_back(std::move(line));
      }
    }
    if (out.empty()) return out;
    if (out.front().text.starts_with(':')) out.front().text.erase(0, 1);  // ACTION Fill:
    if (out.front().text.empty()) out.erase(out.begin());
    if (out.empty()) return out;
    std::string& last = out.back().text;
    const size_t end = last.rfind("END_");
    if (end == std::string::npos) return out;
    last.erase(end);
    last.erase(last.find_last_not_of(" \t") + 1);
    if (last.empty()) out.pop_back();
    return out;
  }

  void add_diagram(Unit& unit, std::string name, uint32_t number) const {
    const frontend::network::Body& body = tree_.diagrams[number];
    const bool ladder = body.language == frontend::network::Language::kLadder;
    unit.bodies.push_back(
        {std::move(name), ladder ? BodyKind::kLadder : BodyKind::kFbd, {}, body});
  }

  void add_chart(Unit& unit, const frontend::Chart& chart) const {
    for (const frontend::ChartStep& step : chart.steps) {
      const std::string name(step.name.text);
      unit.parts.push_back({"step", name, std::string(step.initial ? "initial" : "") +
                                              attributes_text(step.attributes)});
      for (const frontend::ActionUse& use : step.uses) {
        unit.parts.push_back({"action", name + ": " + std::string(use.action.text),
                              slices_.to_semicolon(use.span.begin)});
      }
    }
    for (const frontend::ChartTransition& transition : chart.transitions) {
      const std::string way = steps_text(transition.from) + " -> " + steps_text(transition.to);
      std::string text;
      if (transition.condition.valid()) text = slices_.plain(tree_[transition.condition].span);
      if (transition.has_priority) text += ", priority " + std::to_string(transition.priority);
      if (!transition.name.empty()) text = way + ", " + text;
      unit.parts.push_back({"transition",
                            transition.name.empty() ? way : std::string(transition.name.text),
                            std::move(text)});
    }
    for (const frontend::ChartAction& action : chart.actions) {
      const std::string name = "action " + std::string(action.name.text);
      if (action.diagram != frontend::kNoDiagram) {
        add_diagram(unit, name, action.diagram);
      } else {
        unit.bodies.push_back(
            {name, BodyKind::kText, body_lines({action.span}, action.name.span.end)});
      }
    }
  }
  static std::string steps_text(const std::vector<frontend::Name>& steps) {
    std::string out;
    for (const frontend::Name& step : steps) {
      out += (out.empty() ? "" : ", ") + std::string(step.text);
    }
    return out;
  }

  // The globals of a file are one unit.
  void add_globals() {
    for (size_t i = 0; i < tree_.globals.size();) {
      const std::string_view file = slices_.file(tree_.globals[i].span.begin);
      Unit unit = begin_unit("VAR_GLOBAL", "", tree_.globals[i].span);
      unit.name = unit.file;
      std::string text;
      for (; i < tree_.globals.size(); ++i) {
        const frontend::VarBlock& block = tree_.globals[i];
        if (slices_.file(block.span.begin) != file) break;
        add_variables(unit, block, namespace_of(block.scope));
        text += std::string(slices_.of(slices_.whole(block))) + "\n";
      }
      end_unit(std::move(unit), std::move(text));
    }
  }

  void add_config(const frontend::ConfigDecl& config) {
    Unit unit = begin_unit("CONFIGURATION",
                           namespace_of(config.scope) + std::string(config.name.text), config.span);
    unit.parts.push_back(
        {"declaration", "", "CONFIGURATION" + attributes_text(config.attributes)});
    for (const frontend::VarBlock& block : config.globals) add_variables(unit, block, "");
    for (const frontend::ResourceDecl& resource : config.resources) {
      const std::string name(resource.name.text);
      const std::string prefix = name.empty() ? "" : name + ".";
      if (!name.empty()) {
        unit.parts.push_back({"resource", name, "RESOURCE " + name +
                                                    attributes_text(resource.attributes)});
      }
      for (const frontend::VarBlock& block : resource.globals) add_variables(unit, block, prefix);
      for (const frontend::TaskDecl& task : resource.tasks) {
        unit.parts.push_back({"task", prefix + std::string(task.name.text),
                              slices_.plain(task.span) + attributes_text(task.attributes)});
      }
      for (const frontend::ProgramDecl& program : resource.programs) {
        unit.parts.push_back({"program", prefix + std::string(program.name.text),
                              slices_.plain(program.span) + attributes_text(program.attributes)});
      }
    }
    end_unit(std::move(unit), std::string(slices_.of(config.span)));
  }

  Slices slices_;
  const frontend::Tree& tree_;
  const ProjectFolder& folder_;
  std::vector<Unit> units_;
};

Unit file_unit(const char* kind, std::string file, std::string text) {
  Unit unit;
  unit.kind = kind;
  unit.name = file;
  unit.file = std::move(file);
  unit.line = 1;
  unit.tokens = text;
  unit.text = std::move(text);
  return unit;
}

}  // namespace

std::vector<Unit> units_of(const Project& project) {
  const ProjectFolder folder(project.held_paths());
  frontend::Tree tree;
  base::Diagnostics ignored;  // who builds it reports them
  frontend::parse_all(project.sources, project.compile, tree, ignored);
  std::vector<Unit> units = Units(project.sources, tree, folder).run();
  for (const ReadFile& file : project.other_files) {
    std::string name = folder.path_of(file.path);
    const char* kind = name.ends_with(".toml") ? kSettingsUnit : kDocumentUnit;
    units.push_back(file_unit(kind, std::move(name), file.text));
  }
  for (uint32_t file = 0; file < project.read_sources; ++file) {
    if (!project.sources.is_source(file)) continue;
    std::string text(project.sources.text(file));
    std::string name = folder.path_of(std::string(project.sources.file_name(file)));
    Unit unit = file_unit(kSourceUnit, std::move(name), {});
    unit.tokens = tokens_of(text);
    unit.comments = comments_of(text);
    unit.text = std::move(text);
    units.push_back(std::move(unit));
  }
  return units;
}

}  // namespace stc

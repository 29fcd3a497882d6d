// Reads edits of statements and takes them over.
#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "frontend/parse/parse.h"
#include "frontend/resident_parts.h"

namespace frontend {
namespace {

// Texts and nodes of earlier edits stay. When there are as many as the whole began with, and some
// more, it is time to begin anew.
constexpr size_t kMoreExprs = 1u << 18;
constexpr uint32_t kMoreBytes = 4u << 20;

// The declarations of a tree, put away while others are parsed: who refers to them by address
// finds them where they were.
struct PutAway {
  std::vector<TypeDecl> types;
  std::vector<PouDecl> pous;
  std::vector<VarBlock> globals;
  std::vector<ConfigDecl> configs;
  std::vector<PouDecl> tests;

  void swap(Tree& tree) {
    types.swap(tree.types);
    pous.swap(tree.pous);
    globals.swap(tree.globals);
    configs.swap(tree.configs);
    tests.swap(tree.tests);
  }
};

bool is_unused_message(const base::Diagnostic& message) {
  return message.code == DiagnosticCode::kSecondCoil ||
         message.code == DiagnosticCode::kUnusedVariable ||
         message.code == DiagnosticCode::kNeverWritten ||
         message.code == DiagnosticCode::kResultNeverAssigned;
}

}  // namespace

void Resident::note_files() {
  const base::SourceMap& sources = parsed_->sources;
  first_exprs_ = parsed_->tree.exprs.size();
  first_bytes_ = sources.end().offset;
  files_.clear();
  origins_.clear();
  edited_.clear();
  for (uint32_t number = 0; number < sources.file_count(); ++number) {
    const uint32_t begin = sources.begin(number).offset;
    const auto size = static_cast<uint32_t>(sources.text(number).size());
    files_.push_back({number, false, {}, {{begin, size, begin}}});
    origins_.push_back(number);
  }
  size_t known = before_.size();
  for (const BodyRecord& record : bodies_) known += record.messages.size();
  behind_.assign(diagnostics_.all().begin() + static_cast<ptrdiff_t>(known),
                 diagnostics_.all().end());
  followable_ = std::all_of(behind_.begin(), behind_.end(), is_unused_message);
}

// Parses the file's new text after all others, apart from the declarations that are known.
std::optional<Resident::Edit> Resident::read_edit(uint32_t number, std::string_view text) {
  base::SourceMap& sources = parsed_->sources;
  Tree& tree = parsed_->tree;
  // Lines of tests are told from the first compilation.
  const bool has_test = std::any_of(tree.tests.begin(), tree.tests.end(), [&](const PouDecl& test) {
    return sources.file_of(test.span.begin) == number;
  });
  if (options_.tests && has_test) return std::nullopt;
  File& file = files_[number];
  if (!file.has_places) file.places = code_places(tree.pous, sources, number);
  file.has_places = true;
  Edit edit;
  edit.file = number;
  edit.text = sources.file_count();
  sources.add(std::string(sources.file_name(number)), std::string(text));
  origins_.push_back(number);
  const size_t levels = tree.levels.size();
  LexOptions lexing;
  lexing.defines = options_.defines;
  base::Diagnostics messages;
  PutAway known;
  known.swap(tree);
  parse(sources, edit.text, tree, messages, lexing);
  known.swap(tree);
  edit.pous = std::move(known.pous);
  sema_->facts.notes.grow(tree.exprs.end());
  sema_->facts.specs.resize(tree.specs.size());
  found_errors_ = messages.has_errors();
  if (!messages.all().empty() || tree.levels.size() != levels) return std::nullopt;
  edit.now = code_places(edit.pous, sources, edit.text);
  auto bodies = compare_bodies(sources.text(file.text), file.places, text, edit.now);
  if (!bodies) return std::nullopt;
  edit.bodies = std::move(*bodies);
  const auto lost = [&](const base::Diagnostic& message) {
    const base::SourcePos at = sources.current(message.span.begin);
    if (sources.file_of(at) != file.text) return false;
    const uint32_t offset = at.offset - sources.begin(file.text).offset;
    return std::any_of(edit.bodies.changed.begin(), edit.bodies.changed.end(), [&](size_t i) {
      return offset >= file.places[i].begin && offset <= file.places[i].end;
    });
  };
  if (std::any_of(before_.begin(), before_.end(), lost)) return std::nullopt;
  return edit;
}

// Where the pieces of the file's earlier texts are in its new one.
void Resident::move_pieces(const Edit& edit) {
  const base::SourceMap& sources = parsed_->sources;
  File& file = files_[edit.file];
  const uint32_t old_begin = sources.begin(file.text).offset;
  const uint32_t new_begin = sources.begin(edit.text).offset;
  std::vector<base::SourceMap::Piece> pieces;
  for (const base::SourceMap::Piece& piece : file.pieces) {
    for (const BodyEdits::Kept& kept : edit.bodies.kept) {
      const uint32_t first = std::max(piece.to, old_begin + kept.begin);
      const uint32_t last = std::min(piece.to + piece.size, old_begin + kept.begin + kept.size);
      if (first >= last) continue;
      pieces.push_back({piece.begin + (first - piece.to), last - first,
                        new_begin + kept.to + (first - old_begin - kept.begin)});
    }
  }
  for (const size_t i : edit.bodies.changed) {
    const uint32_t begin = new_begin + edit.now[i].begin;
    pieces.push_back({begin, edit.now[i].end - edit.now[i].begin, begin});
  }
  std::sort(pieces.begin(), pieces.end(),
            [](const auto& a, const auto& b) { return a.begin < b.begin; });
  file.pieces = std::move(pieces);
  file.text = edit.text;
}

void Resident::take_edit(Edit& edit, Undo& undo) {
  undo.files.emplace_back(edit.file, files_[edit.file]);
  move_pieces(edit);
  std::vector<CodePlace>& places = files_[edit.file].places;
  for (const size_t i : edit.bodies.changed) {
    PouDecl& pou = *places[i].pou;
    undo.statements.push_back({&pou, pou.body, pou.code, pou.content});
    pou.body = edit.now[i].pou->body;
    pou.code = edit.now[i].pou->code;
    pou.content = edit.now[i].pou->content;
  }
  for (size_t i = 0; i < places.size(); ++i) {
    places[i].begin = edit.now[i].begin;
    places[i].end = edit.now[i].end;
  }
  edited_.insert(edit.file);
  set_pieces();
}

void Resident::set_pieces() {
  std::vector<base::SourceMap::Piece> all;
  for (const uint32_t file : edited_) {
    all.insert(all.end(), files_[file].pieces.begin(), files_[file].pieces.end());
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.begin < b.begin; });
  parsed_->sources.set_pieces(std::move(all));
}

bool Resident::lower_edited(const std::vector<Edit>& edits, Update& update, Undo& undo) {
  std::set<const PouDecl*> changed;
  for (const Edit& edit : edits) {
    for (const size_t i : edit.bodies.changed) changed.insert(files_[edit.file].places[i].pou);
  }
  for (const PouInfo& info : sema_->declared.pous) {
    if (!info.id.valid() || !changed.contains(info.decl)) continue;
    const uint32_t end = bodies_[info.number].end_constant;
    if (info.made != MadeCode::kNone || !lower_anew(info.number, undo)) return false;
    update.pous.push_back(info.id);
    const BodyRecord& record = bodies_[info.number];
    update.constants.push_back({record.first_constant, end, record.end_constant});
  }
  return true;
}

// Depths of calls that no POU declares (sema/objects/recursion.cc): an edit may give others to POUs
// that it does not touch, and these are not compiled here.
bool Resident::check_uses_again() {
  std::vector<uint32_t> depths;
  for (const PouInfo& info : sema_->declared.pous) depths.push_back(info.usual_depth);
  diagnostics_ = base::Diagnostics();
  check_uses(*sema_);
  bool same = !diagnostics_.has_errors();
  for (PouInfo& info : sema_->declared.pous) {
    const uint32_t before = depths[info.number];
    if (std::exchange(info.usual_depth, before) == before) continue;
    sema_->program.pous[info.id.index].recursion_depth = before;
    same = false;
  }
  if (!same) return false;
  behind_ = diagnostics_.all();
  return true;
}

std::optional<Resident::Update> Resident::follow(const base::SourceMap& sources,
                                                 std::span<const uint32_t> files,
                                                 base::Diagnostics& diagnostics) {
  found_errors_ = false;
  const Tree* tree = followable_ ? &parsed_->tree : nullptr;
  if (tree == nullptr || tree->exprs.size() > 2 * first_exprs_ + kMoreExprs ||
      parsed_->sources.end().offset > 2 * first_bytes_ + kMoreBytes) {
    followable_ = false;
    return std::nullopt;
  }
  Update update;
  std::vector<Edit> edits;
  for (const uint32_t file : files) {
    std::optional<Edit> edit = read_edit(file, sources.text(file));
    if (!edit) return std::nullopt;
    const auto is_shift = [](const LineShift& shift) { return shift.by != 0; };
    const std::vector<LineShift>& lines = edit->bodies.lines;
    if (std::any_of(lines.begin(), lines.end(), is_shift)) {
      update.lines.push_back({std::string(sources.file_name(file)), lines});
    }
    edits.push_back(std::move(*edit));
  }
  const auto has_other_lines = [](const BodyRecord& record) { return record.other_lines; };
  if (!update.lines.empty() && std::any_of(bodies_.begin(), bodies_.end(), has_other_lines)) {
    return std::nullopt;
  }
  uses_changed_ = false;
  Undo undo;
  undo.sizes = sizes();
  undo.behind = behind_;
  for (Edit& edit : edits) take_edit(edit, undo);
  if (!lower_edited(edits, update, undo) || (uses_changed_ && !check_uses_again())) {
    found_errors_ = diagnostics_.has_errors();
    followable_ = undo.complete && sizes() == undo.sizes;  // what was added stays
    undo_edits(undo);
    return std::nullopt;
  }
  report(sources, diagnostics);
  return update;
}

base::SourceSpan Resident::moved(base::SourceSpan span, const base::SourceMap& to) const {
  const base::SourceMap& from = parsed_->sources;
  const auto move = [&](base::SourcePos pos) {
    pos = from.current(pos);
    const uint32_t text = from.file_of(pos);
    if (text == from.file_count()) return pos;
    const uint32_t file = origins_[text];
    const uint32_t library = parsed_->library_file;
    const uint32_t begin =
        file < library ? to.begin(file).offset
                       : to.end().offset + from.begin(file).offset - from.begin(library).offset;
    return base::SourcePos{begin + (pos.offset - from.begin(text).offset)};
  };
  return {move(span.begin), move(span.end)};
}

void Resident::report(const base::SourceMap& sources, base::Diagnostics& out) const {
  const auto add = [&](const Messages& messages) {
    for (base::Diagnostic message : messages) {
      message.span = moved(message.span, sources);
      for (base::DiagnosticNote& note : message.notes) note.span = moved(note.span, sources);
      out.add(std::move(message));
    }
  };
  add(before_);
  for (const BodyRecord& record : bodies_) add(record.messages);
  add(behind_);
}

}  // namespace frontend

// Inside of the export: nodes of PLCopen XML for pieces of the tree.
#pragma once

#include <string>

#include "adapters/plcopen/export.h"
#include "adapters/plcopen/source_text.h"
#include "adapters/xml/document.h"

namespace plcopen {

using xml::Node;

inline constexpr const char* kXhtml = "http://www.w3.org/1999/xhtml";

class Writer {
 public:
  Writer(const ExportInput& input, base::Diagnostics& diagnostics)
      : in_(input), tree_(input.tree), diagnostics_(diagnostics) {
    if (in_.with_sources) parts_.emplace(in_.sources);
    read_texts();
  }

  void project(Node project);
  static void put_characters(Node paragraph,
                             const std::string& text);  // as CDATA, and nothing else
  // The text of the sources; null: none goes into the document.
  SourceParts* parts() { return parts_ ? &*parts_ : nullptr; }

 private:
  using Pou = frontend::PouDecl;
  using SpecId = frontend::SpecId;
  using ExprId = frontend::ExprId;

  struct Globals {  // a block of global variables, with name and attributes of its list
    std::string name;
    const frontend::VarBlock* block;
    frontend::Range32 attributes;
  };

  // No element says it: an error, or a warning where the text of the sources does.
  void fail(base::SourceSpan at, std::string text);
  // `element` is what is declared at `at`; after everything else of it but documentation.
  void tag(Node element, base::SourcePos at) {
    if (parts_) parts_->tag(element, at);
  }

  // --- export_text.cc
  void read_texts();
  std::string_view text_of(uint32_t file) const;
  std::string_view slice(base::SourceSpan span) const;
  std::string flat(base::SourceSpan span) const;  // on one line, without comments
  std::string comment_before(base::SourcePos begin) const;
  std::string comment_behind(base::SourcePos end) const;
  std::string address_of(const frontend::VarDecl& decl) const;
  // The own text of a POU, method, action or accessor, without head, variables, members and END.
  // `head_end` is where name, result and bases end.
  struct Pieces {
    std::string head;  // with the variables
    std::string body;
  };
  Pieces pieces(base::SourceSpan span, base::SourcePos head_end) const;
  base::SourcePos head_end(const Pou& pou) const;
  std::string condition_of(const frontend::ChartTransition& transition, bool& list) const;
  static std::string undented(std::string_view text);
  std::string blanks_before(base::SourceSpan span) const;  // in its line
  void put_text(Node parent, const char* language, const std::string& text) const;
  void put_formatted(Node owner, const std::string& text) const;
  void put_documentation(Node owner, const std::string& text) const;
  static void put_declaration(Node owner, const std::string& text);
  static Node data(Node owner, const char* name);
  std::string attribute_text(frontend::Range32 attributes) const;
  void put_attributes(Node owner, frontend::Range32 attributes);

  // --- export_types.cc
  void put_type(Node parent, SpecId spec);  // an element inside of <type>, <baseType>
  bool put_plain_type(Node parent, const frontend::Spec& spec);
  void put_value(Node parent, ExprId value);
  bool has_elements(const frontend::Expr& value) const;
  bool needs_text(const frontend::Spec& spec) const;
  void data_type(Node parent, const frontend::TypeDecl& type);

  // --- export_variables.cc
  bool put_lists(Node parent, const std::vector<frontend::VarBlock>& blocks);  // false: lossy
  bool put_list(Node parent, const frontend::VarBlock& block, const std::string& name,
                frontend::Range32 attributes);
  bool put_variable(Node list, const frontend::VarBlock& block, const frontend::VarDecl& decl);

  // --- export_pou.cc
  void pou(Node parent, const Pou& pou);
  void interface(Node owner, const Pou& pou, const char* kind);
  void members(Node owner, const Pou& pou);
  void put_access(Node interface, frontend::Access access);
  void body(Node owner, const Pou& pou, const std::string& path);
  void put_body(Node body, const std::string& text, bool list, uint32_t diagram,
                const std::string& path);

  // --- kept.cc
  const xml::KeptChart* kept_chart(const Pou& pou) const;  // null: there is none
  void put_kept(Node project);                             // data of others, in the whole document

  // --- export_chart.cc
  void chart(Node body, const frontend::Chart& chart);

  // --- export_diagram.cc
  void diagram(Node body, const frontend::network::Body& drawn, const std::string& path);
  bool is_in_out(const std::string& type, const std::string& pin) const;
  // What the input of a function at that position is called.
  std::string input_name(const std::string& function, uint32_t position) const;

  // --- export.cc
  void configuration(Node parent, const frontend::ConfigDecl& config,
                     const std::vector<Globals>& lists);
  void resource(Node parent, const frontend::ResourceDecl& resource,
                const std::vector<Globals>& lists);
  std::vector<Globals> global_lists();
  void put_global_list(Node parent, const Globals& list);

  friend class ChartWriter;
  friend class DiagramWriter;

  const ExportInput& in_;
  const frontend::Tree& tree_;
  base::Diagnostics& diagnostics_;
  std::optional<SourceParts> parts_;
  std::vector<std::optional<std::string>> texts_;  // by file: where {IF ...} leaves something out
};

// --- headers.cc
void put_headers(Node project, const ExportInput& input);

// A note for each source of which comments are nowhere below `root`.
void report_lost_comments(const ExportInput& input, Node root, base::Diagnostics& diagnostics);

}  // namespace plcopen

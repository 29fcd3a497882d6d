// Files of other tools as sources (docs/IMPORT.md): what the adapters make of a document becomes
// virtual files named `plant.xml/Motor.st`. The document itself stands in the SourceMap, too, for
// messages about it. Without the adapters' library every such file is refused.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adapters/xml/imported.h"
#include "base/result.h"
#include "base/source.h"
#include "tools/stc/read_file.h"

namespace stc {

// By its extension (kImportable).
bool is_importable(const std::string& path);
inline constexpr const char* kImportable =
    ".xml .exp .export .TcPOU .TcDUT .TcGVL .TcIO .TcTTO .plcproj";
// Is it a file of TwinCAT or CODESYS by its name? Not by .xml, which many other files have.
bool is_foreign(const std::string& path);
// Does it have to be imported? An .exp is a source where all of it is text.
bool needs_import(const std::string& path);

class Importer {
 public:
  // Adds documents to `sources`, which must outlive this.
  explicit Importer(base::SourceMap& sources);
  ~Importer();

  // One file, and what it lists. Errors: kFileNotFound, kFileUnreadable; what is wrong inside is
  // a finding.
  base::Status add(const std::string& path);
  // After the last file: what several of them say together.
  void finish();

  struct Made {
    std::string origin;  // the document's path
    xml::MadeSource source;
  };
  std::vector<Made> made;
  std::vector<ReadFile> read_files;
  std::vector<xml::Finding> findings;
  xml::Kept kept;

 private:
  struct Readers;  // of what is read together
  void read(const std::string& path, const std::string& bytes);
  void read_export(const std::string& path, const std::string& bytes);
  void take(const std::string& origin, xml::Imported& out);

  base::SourceMap& sources_;
  std::unique_ptr<Readers> readers_;
};

// `POU Motor, network 3: text`
std::string located_text(const xml::Finding& finding);

// As the compiler reports. Of warnings each text once; what is left out on purpose (notes) only
// when `notes`.
void add_findings(base::Diagnostics& diagnostics, const std::vector<xml::Finding>& findings,
                  bool notes);

// Without objects of TwinCAT that stand in or below the folder of a .plcproj among them: that says
// which of them belong to the project.
std::vector<std::string> without_listed(const std::vector<std::string>& paths);

}  // namespace stc

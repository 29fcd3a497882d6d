// TwinCAT 3: objects (.TcPOU .TcDUT .TcGVL .TcIO .TcTTO) and projects (.plcproj) -> sources. An
// object holds its declaration and its bodies as text, without the END_ words. Drawn bodies are
// objects of the editor: networks are trees (networks.h), charts are lists (chart.h). CFC is an
// error (E1080), and an {error} stands in its place, so it is never taken for empty.
#pragma once

#include <string>
#include <vector>

#include "adapters/xml/document.h"

namespace twincat {

bool is_object(const xml::Document& document);
bool is_project(const xml::Document& document);

// Tasks are kept until add_tasks(): those of all objects are one CONFIGURATION.
class Importer {
 public:
  explicit Importer(xml::Imported& out) : out_(out) {}
  void add_object(const xml::Document& document);
  // The objects below `root`, as those of CODESYS (codesys/export_file.h).
  void add_objects(xml::Node root, xml::Reporter& report);
  void add_tasks();

 private:
  struct Task {
    std::string name;
    std::string interval;  // T#10000us
    std::string priority;  // may be empty
    std::vector<std::string> programs;
  };
  void add_task(xml::Node node, xml::Reporter& report);

  xml::Imported& out_;
  std::vector<Task> tasks_;
};

// What a .plcproj lists.
struct ListedFile {
  std::string path;  // as written, from the folder of the project on, with `/`
  xml::Node node;
};
std::vector<ListedFile> listed_files(const xml::Document& document, xml::Imported& out);

}  // namespace twincat

// stvm image: the running program as a file, for `stc diff` and `stc package`: a lost build folder
// never forces a stop (X1).
#include <sys/stat.h>

#include <cstdio>

#include "ir/bytecode/image.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kImageOptions[] = {{"--output|-o", "FILE", "image to write (required)"},
                                              tools::kFormatOption,
                                              STVM_CONTROLLER_OPTIONS};
constexpr tools::Command kImageCommand{"image",       "", "Writes the running program to a file.",
                                       kImageOptions, 0,  0};

std::string json_of(const std::string& file, const base::Bytes& image) {
  tools::JsonWriter json;
  json.begin_object().field("file", file);
  json.field("image", base::to_hex(ir::digest(image)));
  json.field("bytes", uint64_t{image.size()}).end_object();
  return json.finish();
}

base::Status fetch(const tools::Options& options) {
  if (!options.has("--output")) {
    return base::Error{base::Refusal::kUsage, "image: --output is required"};
  }
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  base::Result<vm::StatusReport> status = client->status();
  if (!status.ok()) return status.error();
  base::Result<base::Bytes> image = client->image();
  if (!image.ok()) return image.error();
  ::umask(077);  // for its owner only
  base::Status written = tools::write_file(options.text("--output"), *image);
  if (written.ok() && options.text("--format") == "json") {
    std::fputs(json_of(options.text("--output"), *image).c_str(), stdout);
  }
  return written;
}

int run_image(const tools::Options& options) {
  base::Status fetched = fetch(options);
  return fetched.ok() ? tools::kOk : refuse(fetched.error());
}

}  // namespace

const Entry kImage{&kImageCommand, run_image};

}  // namespace stvm

// stvm source: the sources of the running program, where they travel with it (X9). They come as a
// part of its image, in the portions of `stvm image`, which no scan waits for.
#include <sys/stat.h>

#include <cstdio>

#include "ir/bytecode/verify.h"
#include "tools/common/exit.h"
#include "tools/common/source_command.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kSourceOptions[] = {TOOLS_SOURCE_OPTIONS, STVM_CONTROLLER_OPTIONS,
                                               STVM_FORMAT_OPTION};
constexpr tools::Command kSourceCommand{
    "source",       "[ADDRESS]", "Brings back the sources that travel with the running program.",
    kSourceOptions, 0,           1};

base::Result<ControllerClient> connect(const tools::Options& options) {
  if (options.arguments().empty()) return ControllerClient::connect(options);
  if (!options.has("--dir") && !options.has("--host")) {
    return ControllerClient::connect_to(options.arguments()[0]);
  }
  return base::Error{base::Refusal::kUsage, "source: ADDRESS is instead of --dir and --host"};
}

base::Result<std::string> bring(const tools::Options& options) {
  const bool json = wants_json(options);
  base::Result<ControllerClient> client = connect(options);
  if (!client.ok()) return client.error();
  if (auto status = client->status(); !status.ok()) return status.error();
  base::Result<base::Bytes> bytes = client->image();
  if (!bytes.ok()) return bytes.error();
  base::Result<ir::VerifiedImage> image = ir::verify(std::move(*bytes));
  if (!image.ok()) return image.error();
  ::umask(077);  // for their owner only, as images
  return tools::bring_sources(image->encoded(), image->image().name, options, json);
}

int run_source(const tools::Options& options) {
  base::Result<std::string> text = bring(options);
  if (!text.ok()) return refuse(text.error());
  std::fputs(text->c_str(), stdout);
  return tools::kOk;
}

}  // namespace

const Entry kSource{&kSourceCommand, run_source};

}  // namespace stvm

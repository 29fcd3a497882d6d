// Messages: round trips, and hostile bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "vm/runtime/frames.h"
#include "vm/runtime/protocol.h"

namespace vm {
namespace {

std::vector<Request> samples() {
  std::vector<Request> out;
  for (uint8_t i = 0; i < vm::kCommandCount; ++i) {
    Request request{.command = static_cast<Command>(i)};
    request.expected[3] = 7;
    request.edition = 42;
    request.names = {"Main.x", "Line.Filler[3].Count"};
    request.values = {"TRUE", "T#5s"};
    request.offset = 12345;
    request.data = {1, 2, 3, 250};
    request.digest[31] = 9;
    request.flags = kAllowLoss | kPermanent;
    out.push_back(request);
  }
  return out;
}

TEST(Protocol, EveryRequestRoundTrips) {
  for (const Request& request : samples()) {
    base::Bytes bytes = encode(request);
    base::Result<Request> back = decode_request(bytes);
    ASSERT_TRUE(back.ok()) << command_name(request.command);
    EXPECT_EQ(encode(*back), bytes) << command_name(request.command);
    if (changes_state(request.command)) {
      EXPECT_EQ(back->expected, request.expected);
      EXPECT_EQ(back->edition, 42u);
    }
  }
}

TEST(Protocol, TruncatedAndExtendedRequestsAreRefused) {
  for (const Request& request : samples()) {
    base::Bytes bytes = encode(request);
    for (size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(decode_request({bytes.data(), size}).ok()) << command_name(request.command);
    }
    bytes.push_back(0);
    EXPECT_FALSE(decode_request(bytes).ok()) << command_name(request.command);
  }
}

// Whatever arrives is either refused or a request that encodes to the same bytes: nothing is read
// beyond the end, nothing is ignored but zeros of a newer client.
TEST(Protocol, MutatedRequestsAreRefusedOrExact) {
  std::mt19937 random(1);
  uint32_t accepted = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<Request> all = samples();
    base::Bytes bytes = encode(all[random() % all.size()]);
    for (uint32_t i = 0; i <= random() % 4; ++i) {
      bytes[random() % bytes.size()] = static_cast<uint8_t>(random());
    }
    base::Result<Request> request = decode_request(bytes);
    if (!request.ok()) {
      EXPECT_EQ(request.error().refusal, base::Refusal::kProtocol);
      continue;
    }
    ++accepted;
    base::Bytes again = encode(*request);
    if (bytes[0] > kProtocolVersion) again.resize(std::max(again.size(), bytes.size()));
    again[0] = bytes[0];
    EXPECT_EQ(again, bytes);
  }
  EXPECT_GT(accepted, 0u);
}

TEST(Protocol, HostileCountsAllocateNothing) {
  base::ByteWriter writer;
  writer.u8(kProtocolVersion);
  writer.u8(static_cast<uint8_t>(Command::kGet));
  writer.u32(0xffffffff);
  EXPECT_FALSE(decode_request(writer.bytes()).ok());
}

TEST(Protocol, MoreNamesThanTheLimitAreRefused) {
  Request request{.command = Command::kGet};
  request.names.assign(kMaxNames, "a");
  EXPECT_TRUE(decode_request(encode(request)).ok());
  request.names.push_back("a");
  EXPECT_FALSE(decode_request(encode(request)).ok());
  request.names = {std::string(kMaxNameBytes, 'a')};
  EXPECT_TRUE(decode_request(encode(request)).ok());
  request.names = {std::string(kMaxNameBytes + 1, 'a')};
  EXPECT_FALSE(decode_request(encode(request)).ok());
}

TEST(Protocol, AnswersCarryBodiesAndErrors) {
  base::Result<base::Bytes> body = decode_answer(encode_answer(base::Bytes{1, 2}));
  ASSERT_TRUE(body.ok());
  EXPECT_EQ(*body, (base::Bytes{1, 2}));
  base::Result<base::Bytes> error =
      decode_answer(encode_answer(base::Error{base::Refusal::kStaleBase, "other version"}));
  ASSERT_FALSE(error.ok());
  EXPECT_EQ(error.error().refusal, base::Refusal::kStaleBase);
  EXPECT_EQ(error.error().text, "other version");
  EXPECT_EQ(decode_answer(base::Bytes{}).error().refusal, base::Refusal::kProtocol);
  EXPECT_EQ(decode_answer(base::Bytes{kProtocolVersion, 0, 9}).error().refusal,
            base::Refusal::kProtocol);
}

std::string mismatch(uint8_t controller, uint8_t client) {
  return "the controller speaks version " + std::to_string(controller) +
         " of the protocol, the client version " + std::to_string(client) +
         "; use the stvm that the controller was started with, or start the controller again with "
         "this one";
}

// Whichever side is older: what the client shows names both versions and the way out.
TEST(Protocol, OtherVersionsAreNamed) {
  base::Bytes request = encode(Request{.command = Command::kStatus});
  request[0] = kOldestRequest - 1;
  const base::Result<Request> refused = decode_request(request);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kProtocol);
  EXPECT_EQ(refused.error().text, mismatch(kProtocolVersion, kOldestRequest - 1));

  base::Bytes answer = encode_answer(base::Bytes{1, 2});
  answer[0] = kOldestAnswer - 1;
  const base::Result<base::Bytes> body = decode_answer(answer);
  ASSERT_FALSE(body.ok());
  EXPECT_EQ(body.error().text, mismatch(kOldestAnswer - 1, kProtocolVersion));
}

// It reads errors as this version does.
TEST(Protocol, ClientsOfOtherVersionsReadTheError) {
  base::Bytes answer = encode_answer(base::Error{base::Refusal::kProtocol, "versions"}, 9);
  EXPECT_EQ(answer[0], 9);
  answer[0] = kProtocolVersion;
  EXPECT_EQ(decode_answer(answer).error().text, "versions");
}

StatusReport sample_status() {
  StatusReport report;
  report.name = "plant";
  report.running[0] = 1;
  report.change = "trial";
  report.cycles = 77;
  TaskStatus task;
  task.name = "Fast";
  task.scans = 12;
  report.tasks = {task, task};
  report.traps.push_back({5, "Fast", {"P", "p.st", 3, "division"}});
  return report;
}

TEST(Protocol, ReportsRoundTripAndSurviveMutation) {
  base::Bytes bytes = encode(sample_status());
  base::Result<StatusReport> back = decode_status(bytes);
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back->tasks.size(), 2u);
  EXPECT_EQ(back->traps[0].text.line, 3u);
  std::mt19937 random(2);
  for (int round = 0; round < 4000; ++round) {
    base::Bytes mutant = bytes;
    mutant[random() % mutant.size()] = static_cast<uint8_t>(random());
    mutant.resize(random() % 4 == 0 ? random() % mutant.size() : mutant.size());
    base::Result<StatusReport> report = decode_status(mutant);
    if (!report.ok()) continue;
    // What was skipped, and what a terminal would not show, is gone; all else is as it was.
    const base::Bytes again = encode(*report);
    const base::Result<StatusReport> same = decode_status(again);
    ASSERT_TRUE(same.ok());
    EXPECT_EQ(encode(*same), again);
  }
}

// A hostile controller sends what would move the cursor of whoever reads it; names that are asked
// for stay as they are.
TEST(Protocol, TextsOfAnswersAreVisible) {
  StatusReport report = sample_status();
  report.name = "plant\x1b[2J";
  report.traps[0].text.text = "a\nb";
  auto back = decode_status(encode(report));
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back->name, "plant\\x1b[2J");
  EXPECT_EQ(back->traps[0].text.text, "a\\x0ab");
  auto values = decode_values(encode(Values{1, 1, 0, {{"\x07", "T", "\xc2\x9b"}}}));
  ASSERT_TRUE(values.ok());
  EXPECT_EQ(values->rows[0].path, "\\x07");
  EXPECT_EQ(values->rows[0].value, "\\xc2\\x9b");
  auto error = decode_answer(encode_answer(base::Error{base::Refusal::kBusy, "\x1b]0;x\x07"}));
  ASSERT_FALSE(error.ok());
  EXPECT_EQ(error.error().text, "\\x1b]0;x\\x07");
  Request request{.command = Command::kGet};
  request.names = {"s\x1b"};
  auto asked = decode_request(encode(request));
  ASSERT_TRUE(asked.ok());
  EXPECT_EQ(asked->names[0], "s\x1b");
}

TEST(Frames, ComeTogetherFromAnyPieces) {
  base::Bytes stream;
  for (const char* text : {"", "a", "hello"}) {
    base::Bytes one = frame(base::as_bytes(text));
    stream.insert(stream.end(), one.begin(), one.end());
  }
  for (size_t step = 1; step <= stream.size(); ++step) {
    FrameReader reader;
    std::vector<base::Bytes> got;
    for (size_t at = 0; at < stream.size(); at += step) {
      reader.add({stream.data() + at, std::min(step, stream.size() - at)});
      while (auto message = reader.next()) got.push_back(*message);
    }
    ASSERT_EQ(got.size(), 3u) << step;
    EXPECT_EQ(got[2].size(), 5u);
    EXPECT_TRUE(reader.empty());
  }
}

TEST(Frames, LengthAboveTheLimitBreaksTheStream) {
  for (uint32_t length : {kMaxMessageBytes, kMaxMessageBytes + 1, 0xffffffffu}) {
    base::ByteWriter writer;
    writer.u32(length);
    FrameReader reader;
    reader.add(writer.bytes());
    EXPECT_FALSE(reader.next().has_value());
    EXPECT_EQ(reader.broken(), length > kMaxMessageBytes);
  }
}

}  // namespace
}  // namespace vm

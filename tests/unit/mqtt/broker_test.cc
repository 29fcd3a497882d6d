// What a broker that is not to be trusted can make this side hold, and what it cannot.
#include "adapters/mqtt/broker.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/unit/mqtt/false_broker.h"

namespace {

using Kind = mqtt::Event::Kind;

constexpr int64_t kLongMs = 600'000;  // never waited for: what is awaited comes

class Brokers : public testing::Test {
 protected:
  void SetUp() override {
    mqtt::Settings settings;
    settings.url = false_.url();
    settings.client = "line1";
    base::Result<std::unique_ptr<mqtt::Broker>> broker = mqtt::connect(settings);
    ASSERT_TRUE(broker.ok()) << base::to_string(broker.error());
    broker_ = std::move(*broker);
    false_.welcome();
    const std::optional<mqtt::Event> event = broker_->wait(kLongMs);
    ASSERT_TRUE(event && event->kind == Kind::kConnected);
  }

  // Topics and numbers of messages; "" behind the last one.
  std::optional<mqtt::Message> next() {
    std::optional<mqtt::Event> event = broker_->wait(0);
    if (!event) return std::nullopt;
    EXPECT_EQ(event->kind, Kind::kMessage);
    return std::move(event->message);
  }

  FalseBroker false_;
  std::unique_ptr<mqtt::Broker> broker_;
};

TEST_F(Brokers, F03_MessagesThatNobodyTakesAreBounded) {
  const base::Bytes payload(10, 1);
  for (size_t i = 0; i < mqtt::kMostWaiting + 100; ++i) false_.send(std::to_string(i), payload);
  false_.send_and_hear();
  for (size_t i = 0; i < mqtt::kMostWaiting; ++i) {
    const std::optional<mqtt::Message> message = next();
    ASSERT_TRUE(message) << i;
    ASSERT_EQ(message->topic, std::to_string(i));
    ASSERT_EQ(message->payload, payload);
  }
  EXPECT_FALSE(next()) << "more are lost, this one too";
  false_.send_and_hear();
  const std::optional<mqtt::Message> message = next();
  ASSERT_TRUE(message) << "and there is room again";
  EXPECT_EQ(message->topic, "seen");
}

TEST_F(Brokers, F03_BytesThatNobodyTakesAreBounded) {
  const base::Bytes largest(mqtt::kMostPayload, 2);
  const size_t most = mqtt::kMostWaitingBytes / mqtt::kMostPayload;
  for (size_t i = 0; i < most + 8; ++i) false_.send("large", largest);
  false_.send_and_hear();
  size_t bytes = 0;
  size_t messages = 0;
  while (const std::optional<mqtt::Message> message = next()) {
    bytes += message->payload.size();
    ++messages;
  }
  EXPECT_EQ(bytes, mqtt::kMostWaitingBytes);
  EXPECT_EQ(messages, most + 1) << "one without content has room";
}

TEST_F(Brokers, F03_APayloadThatIsTooLongIsDropped) {
  false_.send("long", base::Bytes(mqtt::kMostPayload + 1, 3));
  false_.send_and_hear();
  const std::optional<mqtt::Message> message = next();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->topic, "seen");
  EXPECT_FALSE(broker_->publish("long", base::Bytes(mqtt::kMostPayload + 1, 3), false).ok());
}

TEST_F(Brokers, F03_MessagesThatTheBrokerDoesNotTakeAreBounded) {
  const base::Bytes payload(10, 4);
  for (size_t i = 0; i < mqtt::kMostLeaving; ++i) {
    ASSERT_TRUE(broker_->publish("status", payload, true).ok()) << i;
  }
  const base::Status refused = broker_->publish("status", payload, true);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kTooMany);
  EXPECT_FALSE(broker_->flush(0));
  // What it takes makes room for as much.
  for (size_t i = 0; i < mqtt::kMostLeaving; ++i) {
    const FalseBroker::Published one = false_.next_published();
    ASSERT_EQ(one.size, payload.size());
    false_.acknowledge(one.number);
  }
  EXPECT_TRUE(broker_->flush(kLongMs));
  EXPECT_TRUE(broker_->publish("status", payload, true).ok());
}

TEST_F(Brokers, F03_AReceiptForWhatNobodyPublishedCountsForNothing) {
  for (uint16_t number = 1; number <= 1000; ++number) false_.acknowledge(number);
  false_.send_and_hear();
  for (size_t i = 0; i < mqtt::kMostLeaving; ++i) {
    ASSERT_TRUE(broker_->publish("status", base::Bytes(1, 6), true).ok()) << i;
  }
  EXPECT_FALSE(broker_->publish("status", base::Bytes(1, 6), true).ok());
}

TEST_F(Brokers, F03_BytesThatTheBrokerDoesNotTakeAreBounded) {
  const base::Bytes largest(mqtt::kMostPayload, 5);
  const size_t most = mqtt::kMostLeavingBytes / mqtt::kMostPayload;
  for (size_t i = 0; i < most; ++i) ASSERT_TRUE(broker_->publish("file", largest, true).ok()) << i;
  EXPECT_FALSE(broker_->publish("file", base::Bytes(1, 5), true).ok());
  EXPECT_TRUE(broker_->publish("status", {}, true).ok());
  false_.acknowledge(false_.next_published().number);
  const FalseBroker::Published second = false_.next_published();
  false_.send_and_hear();  // so the first one was heard of
  EXPECT_TRUE(broker_->publish("file", largest, true).ok());
  EXPECT_FALSE(broker_->publish("file", base::Bytes(1, 5), true).ok());
  false_.acknowledge(second.number);
}

// A private key too, which is looked at before anything is sent.
TEST(BrokerSecrets, F03_WhatEverybodyCanReadIsNoSecret) {
  const std::string path = testing::TempDir() + "broker-secret-" + std::to_string(::getpid());
  std::ofstream(path) << "word\n";
  mqtt::Settings settings;
  settings.url = "mqtt://127.0.0.1:1";
  settings.client = "line1";
  settings.user = "line1";
  settings.password_file = path;
  mqtt::Settings tls;
  tls.url = "mqtts://127.0.0.1:1";
  tls.client = "line1";
  tls.certificate = tls.key = path;
  for (const mqtt::Settings& asked : {settings, tls}) {
    for (const mode_t mode : {0644, 0602}) {
      ASSERT_EQ(::chmod(path.c_str(), mode), 0);
      const auto broker = mqtt::connect(asked);
      ASSERT_FALSE(broker.ok());
      EXPECT_EQ(broker.error().refusal, base::Refusal::kBadKeys);
      EXPECT_NE(broker.error().text.find("chmod 640"), std::string::npos);
    }
    ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
    const auto broker = mqtt::connect(asked);
    EXPECT_TRUE(broker.ok() || broker.error().refusal != base::Refusal::kBadKeys);
  }
  std::filesystem::remove(path);
}

}  // namespace

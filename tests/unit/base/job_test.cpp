#include "base/job.h"

#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"

namespace marey {
namespace {

TEST(Job, IsDoneWithItsFractionFullWhenTheWorkReturns) {
  Job job([](Progress& progress) { progress.report(0.25, "a quarter"); });
  job.wait();
  const auto status = job.status();
  EXPECT_EQ(status.state, Job::State::Done);
  EXPECT_EQ(status.fraction, 1.0);
  EXPECT_EQ(status.message, "a quarter");
  EXPECT_TRUE(status.error.empty());
}

TEST(Job, KeepsTheTextOfTheErrorAndTheProgressReached) {
  Job job([](Progress& progress) {
    progress.report(0.5, "half");
    throw InputError({.path = "walk.bvh", .line = 7}, "3 numbers", "2");
  });
  job.wait();
  const auto status = job.status();
  EXPECT_EQ(status.state, Job::State::Failed);
  EXPECT_EQ(status.error, "walk.bvh:7: expected 3 numbers, found 2");
  EXPECT_EQ(status.fraction, 0.5);
}

TEST(Job, SurvivesThrownValuesThatAreNoExceptions) {
  Job job([](Progress&) { throw 42; });
  job.wait();
  EXPECT_EQ(job.status().state, Job::State::Failed);
  EXPECT_FALSE(job.status().error.empty());
}

TEST(Job, StopsAtTheNextQuestionAfterARequest) {
  std::promise<void> started;
  Job job([&started](Progress& progress) {
    started.set_value();
    while (true) {
      progress.throwIfCancelled();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  started.get_future().wait();
  EXPECT_EQ(job.status().state, Job::State::Running);
  job.requestStop();
  job.wait();
  EXPECT_EQ(job.status().state, Job::State::Cancelled);
  EXPECT_TRUE(job.status().error.empty());
}

TEST(Job, StopsAndJoinsWhenDestroyed) {
  std::promise<void> started;
  std::atomic<bool> ended{false};
  {
    Job job([&](Progress& progress) {
      started.set_value();
      while (!progress.cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ended = true;
    });
    started.get_future().wait();
  }
  EXPECT_TRUE(ended);
}

std::vector<double> reported(const std::vector<double>& fractions) {
  std::vector<double> out;
  Progress progress([&out](double fraction, std::string_view) { out.push_back(fraction); });
  for (const double f : fractions) progress.report(f);
  return out;
}

TEST(ProgressReports, NeverFallAndStayWithinZeroAndOne) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(reported({-1.0, 0.3, 0.2, nan, 0.4, 7.0, 0.5}),
            (std::vector<double>{0.0, 0.3, 0.3, 0.3, 0.4, 1.0, 1.0}));
}

TEST(ProgressReports, OfAPartFillItsShareOfTheWhole) {
  std::vector<double> out;
  Progress whole([&out](double fraction, std::string_view) { out.push_back(fraction); });
  Progress first = whole.part(0.0, 0.5);
  first.report(0.5);
  first.report(1.0);
  Progress second = whole.part(0.5, 1.0);
  second.report(0.5);
  EXPECT_EQ(out, (std::vector<double>{0.25, 0.5, 0.75}));
}

TEST(ProgressReports, StayInOrderFromManyThreads) {
  std::vector<double> out;
  Progress progress([&out](double fraction, std::string_view) { out.push_back(fraction); });
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&progress] {
        for (int i = 0; i <= 500; ++i) progress.report(i / 500.0);
      });
  }
  EXPECT_EQ(out.size(), 4u * 501u);
  EXPECT_TRUE(std::is_sorted(out.begin(), out.end()));
}

TEST(ProgressParts, AreCancelledWithTheWhole) {
  std::stop_source source;
  Progress whole({}, source.get_token());
  Progress part = whole.part(0.2, 0.4);
  EXPECT_NO_THROW(part.throwIfCancelled());
  source.request_stop();
  EXPECT_THROW(part.throwIfCancelled(), CancelledError);
}

}  // namespace
}  // namespace marey

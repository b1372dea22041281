#include "tests/layout/include_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace recald::layout {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(IncludeRules, HoldForThisTree) {
  const Includes includes = read_includes(RECALD_SOURCE_DIR);
  ASSERT_GT(includes.size(), 500u) << "the sources were not found";
  EXPECT_THAT(forbidden_arrows(includes), IsEmpty());
  EXPECT_THAT(circles(includes), IsEmpty());
}

TEST(IncludeRules, ArrowsPointDownTheWingsAndTheirRooms) {
  EXPECT_THAT(
      forbidden_arrows({{"daemon/gateway/run/gateway.cpp",
                         {"core/result.hpp", "adapters/ports/store.hpp",
                          "daemon/site/config/site_config.hpp", "daemon/gateway/serve/served.hpp"}},
                        {"daemon/main.cpp", {"daemon/commands/cli.hpp"}}}),
      IsEmpty());
  EXPECT_THAT(
      forbidden_arrows({{"daemon/gateway/serve/served.hpp", {"daemon/gateway/run/gateway.hpp"}}}),
      ElementsAre("daemon/gateway/serve/served.hpp must not include "
                  "daemon/gateway/run/gateway.hpp"));
  EXPECT_EQ(forbidden_arrows({{"daemon/site/model/a.cpp", {"daemon/site/results/b.hpp"}},
                              {"daemon/site/results/b.cpp", {"daemon/gateway/poll/c.hpp"}},
                              {"adapters/csv/d.cpp", {"daemon/site/config/e.hpp"}},
                              {"core/drift/f.cpp", {"adapters/ports/clock.hpp"}}})
                .size(),
            4u);
}

TEST(IncludeRules, AFolderWithoutAPlaceInTheOrderIsRefused) {
  EXPECT_EQ(forbidden_arrows({{"daemon/site/cellar/a.cpp", {"core/result.hpp"}}}).size(), 1u);
}

TEST(IncludeRules, OneRoomKnowsWhatKeepsAStore) {
  EXPECT_THAT(forbidden_arrows({{"adapters/stores/open.cpp", {"adapters/sqlite/sqlite_store.hpp"}},
                                {"adapters/sqlite/backup.cpp", {"adapters/sqlite/handles.hpp"}},
                                {"adapters/energyplus/a.cpp", {"adapters/sqlite/database.hpp"}}}),
              IsEmpty());
  EXPECT_EQ(forbidden_arrows({{"daemon/gateway/run/a.cpp", {"adapters/sqlite/sqlite_store.hpp"}},
                              {"adapters/models/b.cpp", {"adapters/sqlite/database.hpp"}}})
                .size(),
            2u);
}

TEST(IncludeRules, SimulatorsHaveNothingOfTheModelsTheyTest) {
  EXPECT_THAT(forbidden_arrows({{"simulators/building/a.cpp",
                                 {"core/metering/reading.hpp", "simulators/climate/sky.hpp"}}}),
              IsEmpty());
  EXPECT_EQ(forbidden_arrows({{"simulators/building/a.cpp",
                               {"core/weather/psychrometrics.hpp", "adapters/modbus/frame.hpp"}}})
                .size(),
            2u);
}

TEST(IncludeRules, CirclesAreFoundAroundACornerToo) {
  EXPECT_THAT(circles({{"core/a/x.cpp", {"core/b/y.hpp"}},
                       {"core/b/y.hpp", {"core/c/z.hpp"}},
                       {"core/c/z.cpp", {"core/a/x.hpp"}},
                       {"core/d/w.cpp", {"core/a/x.hpp", "core/d/v.hpp"}}}),
              ElementsAre("core/a core/b core/c"));
}

}  // namespace
}  // namespace recald::layout

/// A site served on a real socket, with what its configuration names.
#include "daemon/gateway/serve/site_server.hpp"

#include <gmock/gmock.h>

#include <boost/asio/io_context.hpp>
#include <thread>

#include "adapters/http/client.hpp"
#include "tests/adapters/http/self_signed.hpp"
#include "tests/daemon/gateway/serve/served_site.hpp"

namespace recald::daemon {
namespace {

using recald::testing::write_self_signed;
using ::testing::HasSubstr;

class SiteServer : public ServedSite {
 protected:
  SiteServer() {
    recald::testing::write_text(folder_ / "token", "0123456789abcdef\n");
    using std::filesystem::perms;
    std::filesystem::permissions(folder_ / "token", perms::owner_read | perms::owner_write);
  }
  ~SiteServer() override { context_.stop(); }

  std::uint16_t serve(const HttpConfig& config) {
    server_ = std::move(serve_site(context_, config, served_).value());
    const std::uint16_t port = server_->port();
    thread_ = std::jthread{[this] { context_.run(); }};
    return port;
  }

  boost::asio::io_context context_{1};
  std::unique_ptr<http::Server> server_;
  std::jthread thread_;
};

TEST_F(SiteServer, IsReachedAtItsAddress) {
  const std::uint16_t port = serve({.address = "127.0.0.1", .port = 0});
  const auto response = http::get({.port = port, .path = "/api/v1/sites"});
  ASSERT_TRUE(response.has_value()) << response.error().message;
  EXPECT_THAT(response->body, HasSubstr("\"id\":\"tower\""));
}

TEST_F(SiteServer, AsksForTheTokenOverTls) {
  const auto tls = write_self_signed(folder_.path(), "tower");
  const std::uint16_t port = serve({.port = 0,
                                    .token_file = folder_ / "token",
                                    .certificate_file = tls.certificate,
                                    .key_file = tls.key});
  const auto status_of = [&](const std::string& path, const std::string& token) {
    const auto response = http::get({.is_tls = true, .port = port, .path = path},
                                    {.token = token, .trusted_certificate = tls.certificate});
    return response ? response->status : 0;
  };
  EXPECT_EQ(status_of("/metrics", "0123456789abcdef"), 200);
  EXPECT_EQ(status_of("/metrics", "wrong"), 401);
  EXPECT_EQ(status_of("/readyz", ""), 200);
  EXPECT_EQ(status_of("/healthz", ""), 200);
  EXPECT_EQ(status_of("/", ""), 401);
}

TEST_F(SiteServer, DoesNotBeginWithoutItsToken) {
  const auto server =
      serve_site(context_, {.port = 0, .token_file = folder_ / "no-token"}, served_);
  ASSERT_FALSE(server.has_value());
  EXPECT_THAT(server.error().message, HasSubstr("cannot be found"));
}

}  // namespace
}  // namespace recald::daemon

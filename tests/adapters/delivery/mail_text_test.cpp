#include "adapters/delivery/mail_text.hpp"

#include <gmock/gmock.h>

namespace recald::delivery::mail_text_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Mail usual() {
  return {.from = "recald@example.org",
          .to = {"ada@example.org", "bob@example.org"},
          .subject = "Depot: meter main is silent",
          .text = "Since noon.\n",
          .id = "depot-17",
          .date = std::chrono::sys_days{std::chrono::year{2026} / 1 / 2} + std::chrono::hours{3}};
}

TEST(MailText, HasWhatAServerAsksFor) {
  const std::string text = mail_text(usual());
  EXPECT_THAT(text, StartsWith("From: recald@example.org\r\nTo: ada@example.org,\r\n "
                               "bob@example.org\r\nSubject: Depot: meter main is silent\r\n"
                               "Date: Fri, 02 Jan 2026 03:00:00 +0000\r\n"
                               "Message-ID: <depot-17@example.org>\r\n"));
  EXPECT_THAT(text, HasSubstr("\r\n\r\nU2luY2Ugbm9vbi4K\r\n"));
}

// "Gebäude" five times over, cut between characters into words of at most 75 characters.
TEST(MailText, OtherScriptsAreEncoded) {
  Mail mail = usual();
  mail.subject = "Gebäude Gebäude Gebäude Gebäude Gebäude";
  const std::string text = mail_text(mail);
  EXPECT_THAT(text, HasSubstr("Subject: =?utf-8?B?R2Viw6R1ZGUgR2Viw6R1ZGUgR2Viw6R1ZGUgR2Viw6R1ZGUg"
                              "R2Vi?=\r\n =?utf-8?B?w6R1ZGU=?=\r\n"));
}

// A site's name with a line break in it must not add a recipient.
TEST(MailText, ALineBreakBecomesNoHeader) {
  Mail mail = usual();
  mail.subject = "Depot\r\nBcc: eve@example.org";
  EXPECT_THAT(mail_text(mail), Not(HasSubstr("\nBcc")));
}

}  // namespace
}  // namespace recald::delivery::mail_text_test

// SPDX-License-Identifier: LGPL-2.1-or-later
// The reports as a browser shows them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "browser.h"
#include "tests/support/results.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::Browser;
using test::PageRecord;
using test::read_text;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// What is wrong with a page's layout, a line each: a figure that is not there to be seen or sticks
/// out, a page that is wider than the screen, an id that is there twice.
constexpr const char* layout_faults = R"js((() => {
  const faults = [];
  const width = document.documentElement.clientWidth;
  const drawings = document.querySelectorAll('figure svg, figure img');
  for (const d of drawings) {
    const r = d.getBoundingClientRect();
    if (r.width < 100 || r.height < 50) faults.push('small: ' + d.id + ' ' + r.width + ' x ' + r.height);
    if (r.left < 0 || r.right > width + 0.5) faults.push('out of the page: ' + d.id);
    if (!d.checkVisibility({checkOpacity: true, checkVisibilityCSS: true})) faults.push('hidden: ' + d.id);
    if (d.tagName === 'IMG' && d.naturalWidth === 0) faults.push('no picture: ' + d.id);
    if (d.tagName === 'svg' && d.getBBox().width < 10) faults.push('nothing drawn: ' + d.id);
    if (d.tagName === 'svg' && !d.querySelector('title').textContent) faults.push('no title: ' + d.id);
  }
  if (drawings.length === 0) faults.push('no figure');
  if (document.documentElement.scrollWidth > width) faults.push('the page is ' + document.documentElement.scrollWidth + ' wide on ' + width);
  const ids = [...document.querySelectorAll('[id]')].map(e => e.id);
  for (const id of ids) if (ids.indexOf(id) !== ids.lastIndexOf(id)) faults.push('id twice: ' + id);
  for (const a of document.querySelectorAll('a[href^="#"]')) if (!document.getElementById(a.getAttribute('href').slice(1))) faults.push('leads nowhere: ' + a.getAttribute('href'));
  for (const u of document.querySelectorAll('use')) if (!document.querySelector(u.getAttribute('xlink:href'))) faults.push('mark without a shape');
  for (const s of document.querySelectorAll('.scroll, pre')) if (s.scrollWidth > s.clientWidth && s.tabIndex !== 0) faults.push('cannot be scrolled by keyboard');
  return faults;
})())js";

class ReportInChromium : public testing::Test {
 protected:
  void SetUp() override {
    if (!Browser::is_installed())
      GTEST_SKIP() << "chromium is not installed (apt-get install chromium)";
  }

  /// The page with something before its end.
  static fs::path with(const fs::path& report, const std::string& what, bool without_policy) {
    std::string text = read_text(report);
    text.insert(text.find("</main>"), what);
    if (without_policy) {
      const std::size_t policy = text.find("<meta http-equiv");
      text.erase(policy, text.find('>', policy) + 1 - policy);
    }
    fs::path file = report.parent_path() / "planted.html";
    std::ofstream(file) << text;
    return file;
  }
};

void expect_clean(Browser& browser, const fs::path& file, int width) {
  const PageRecord record = browser.open(file, width);
  EXPECT_THAT(record.messages, IsEmpty()) << file << " at " << width;
  EXPECT_THAT(record.requests, IsEmpty()) << file << " at " << width;
  const auto faults = browser.evaluate(layout_faults).get<std::vector<std::string>>();
  EXPECT_THAT(faults, IsEmpty()) << file << " at " << width;
}

// Everything closed, then everything open: tables, case files, other load steps.
TEST_F(ReportInChromium, EveryFigureIsSeenNothingIsLoadedAndThePageFitsAPhoneAndAScreen) {
  const test::Results results;
  Browser browser;
  for (const fs::path& file :
       {results.results() / "report.html", results.results() / "one/report.html"})
    for (const int width : {360, 1280}) {
      expect_clean(browser, file, width);
      browser.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)");
      EXPECT_THAT(browser.evaluate(layout_faults).get<std::vector<std::string>>(), IsEmpty())
          << file << " opened, at " << width;
    }
  // A case of its own: its shapes, ΔB and B; then six outputs of the study, the picture.
  EXPECT_EQ(browser.evaluate("document.querySelectorAll('figure').length"), 7);
  browser.open(results.results() / "report.html", 1280);
  EXPECT_GE(browser.evaluate("document.querySelectorAll('figure').length"), 7 + 4 + 4 + 1 + 1);
}

// Each check fails on a page that is bad in its way.
TEST_F(ReportInChromium, TheChecksSeeWhatTheyLookFor) {
  const test::Results results;
  const fs::path report = results.results() / "one/report.html";
  Browser browser;
  const auto opened = [&](const std::string& what, bool without_policy) {
    return browser.open(with(report, what, without_policy), 360);
  };
  const auto faults = [&](const std::string& what) {
    opened(what, false);
    return browser.evaluate(layout_faults).get<std::vector<std::string>>();
  };
  const std::string image = "<img alt='' src='http://127.0.0.1:9/x.png'>";
  EXPECT_THAT(opened(image, true).requests, Contains("http://127.0.0.1:9/x.png"));
  const std::string script = "<script>console.error('planted')</script>";
  EXPECT_THAT(opened(script, true).messages, Contains(HasSubstr("planted")));
  const std::string thrown = "<script>throw new Error('thrown')</script>";
  EXPECT_THAT(opened(thrown, true).messages, Contains(HasSubstr("thrown")));
  // The page's own policy stops both, and says so.
  const PageRecord stopped = opened(image + script, false);
  EXPECT_THAT(stopped.messages, Contains(HasSubstr("Content Security Policy")));
  EXPECT_THAT(stopped.messages, Not(Contains(HasSubstr("planted"))));
  const std::string svg =
      "<svg id='planted' viewBox='0 0 9 9'><title>t</title><rect width='99' height='99'/></svg>";
  EXPECT_THAT(faults("<figure style='width:0'>" + svg + "</figure>"),
              Contains(HasSubstr("small: planted")));
  EXPECT_THAT(faults("<figure style='visibility:hidden'>" + svg + "</figure>"),
              Contains("hidden: planted"));
  EXPECT_THAT(
      faults("<figure><svg id='planted' width='300' height='300'><title>t</title></svg></figure>"),
      Contains("nothing drawn: planted"));
  EXPECT_THAT(faults("<figure style='width:700px'>" + svg + "</figure>"),
              Contains("out of the page: planted"));
  EXPECT_THAT(faults("<div style='width:500px'>wide</div>"),
              Contains("the page is 516 wide on 360"));
  EXPECT_THAT(faults("<div class='scroll'><div style='width:700px'>wide</div></div>"),
              Contains("cannot be scrolled by keyboard"));
  EXPECT_THAT(faults("<p id='main'>again</p>"), Contains("id twice: main"));
  EXPECT_THAT(faults("<a href='#nowhere'>x</a>"), Contains("leads nowhere: #nowhere"));
}

TEST_F(ReportInChromium, TheKeyboardReachesContentsTablesAndDetails) {
  const test::Results results;
  Browser browser;
  browser.open(results.results() / "report.html", 360);
  const std::string focused = "document.activeElement.";
  browser.press("Tab", 9);
  EXPECT_EQ(browser.evaluate(focused + "textContent"), "Skip the contents");
  EXPECT_GE(browser.evaluate(focused + "getBoundingClientRect().left").get<double>(), 0);
  browser.press("Enter", 13);
  EXPECT_EQ(browser.evaluate(focused + "id"), "main");
  // The first table is wider than a phone: the arrows move it.
  browser.press("Tab", 9);
  EXPECT_EQ(browser.evaluate(focused + "className"), "scroll");
  for (int i = 0; i < 3; ++i) browser.press("ArrowRight", 39);
  browser.evaluate("new Promise(r => setTimeout(() => r(1), 500))");  // it scrolls smoothly
  EXPECT_GT(browser.evaluate(focused + "scrollLeft").get<double>(), 0);
  for (int i = 0; i < 20 && browser.evaluate(focused + "tagName") != "SUMMARY"; ++i)
    browser.press("Tab", 9);
  ASSERT_EQ(browser.evaluate(focused + "tagName"), "SUMMARY");
  browser.press("Enter", 13);
  EXPECT_EQ(browser.evaluate(focused + "parentElement.open"), true);
}

// A title from the user's file that is markup stands there as text.
TEST_F(ReportInChromium, WhatStandsInAUsersFileIsTextAndNoMarkup) {
  const std::string markup = R"(<script>console.error('ran')</script><b id="main">&amp; "q")";
  const test::Results results(markup);
  Browser browser;
  for (const fs::path& file :
       {results.results() / "report.html", results.results() / "one/report.html"}) {
    expect_clean(browser, file, 1280);
    EXPECT_EQ(browser.evaluate("document.scripts.length"), 0);
    EXPECT_THAT(browser.evaluate("document.body.innerText").get<std::string>(), HasSubstr(markup));
  }
}

}  // namespace
}  // namespace ciliaval

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::compare::report {

/// The style sheet of every report: light and dark as the reader's system is, from a phone to a
/// wide screen; figures stay on white.
inline constexpr const char* style_sheet = R"css(
:root { color-scheme: light dark; --paper: #fff; --ink: #1c1e21; --faint: #5c6470; --line: #d5d9df;
  --box: #f4f6f8; --link: #0b57a4; --bad: #a4161a; --e1: #eaf3ea; --e2: #fdf6dc; --e3: #fde6cf; --e4: #f9d2cf; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #16181c; --ink: #e4e6ea; --faint: #a2a9b4; --line: #3a3f47; --box: #20242a;
    --link: #8ab8f0; --bad: #ff8a80; --e1: #1d3322; --e2: #3a3413; --e3: #4a2f14; --e4: #512121; }
}
* { box-sizing: border-box; }
html { scroll-padding-top: 1rem; }
body { margin: 0; background: var(--paper); color: var(--ink); line-height: 1.5;
  font-family: system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
header, nav, main, footer { max-width: 76rem; margin: 0 auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 1.5rem 0 .5rem; }
h2 { font-size: 1.3rem; line-height: 1.3; margin: 2.5rem 0 .75rem; padding-top: .75rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.05rem; margin: 1.75rem 0 .5rem; }
h1, h2, h3, p, li, figcaption, summary, caption { overflow-wrap: anywhere; }
p { margin: .5rem 0; max-width: 70ch; }
a { color: var(--link); }
:focus-visible { outline: 3px solid var(--link); outline-offset: 2px; }
.skip { position: absolute; left: -100vw; top: 0; padding: .5rem 1rem; background: var(--paper); z-index: 1; }
.skip:focus { left: 0; }
nav ul { columns: 20rem; padding-left: 1.1rem; margin: .25rem 0; }
nav li { margin: .15rem 0; }
.figures { display: grid; gap: 1rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 21rem), 1fr)); align-items: start; }
.figures.wide { grid-template-columns: repeat(auto-fit, minmax(min(100%, 27rem), 1fr)); }
figure { margin: .75rem 0; min-width: 0; }
.plot { background: #fff; border: 1px solid var(--line); border-radius: 6px; padding: .25rem; }
.plot svg, .plot img { display: block; width: 100%; height: auto; margin: 0 auto; }
figcaption { color: var(--faint); font-size: .9rem; margin-top: .35rem; max-width: 70ch; }
.scroll { overflow-x: auto; max-width: 100%; margin: .75rem 0; }
table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--faint); padding: 0 0 .35rem; }
th, td { padding: .2rem .6rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
thead th { border-bottom: 2px solid var(--line); vertical-align: bottom; }
tbody th, thead th:first-child { text-align: left; font-weight: 600; }
td.text, th.text { text-align: left; white-space: normal; min-width: 12rem; max-width: 34rem; overflow-wrap: anywhere; }
td.word, th.word { text-align: left; }
td.e1 { background: var(--e1); } td.e2 { background: var(--e2); } td.e3 { background: var(--e3); } td.e4 { background: var(--e4); }
td.faint { color: var(--faint); }
td.strong { font-weight: 600; }
tbody th.plain { font-weight: 400; }
td[rowspan], th[rowspan] { vertical-align: top; }
.bad { color: var(--bad); font-weight: 600; }
details { margin: .5rem 0; }
summary { cursor: pointer; color: var(--link); padding: .15rem 0; }
pre { overflow-x: auto; background: var(--box); border: 1px solid var(--line); border-radius: 6px; padding: .75rem; font-size: .8rem; margin: .5rem 0; }
footer { color: var(--faint); font-size: .875rem; border-top: 1px solid var(--line); margin-top: 3rem; padding-bottom: 2rem; }
@media print { nav, .skip { display: none; } .scroll, pre { overflow: visible; } }
)css";

}  // namespace ciliaval::compare::report

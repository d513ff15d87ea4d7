#include "pages/assets.h"

namespace lumirank::pages {

// Eight hues of about one lightness per scheme, so that no curve stands out by accident.
const char* const kCompareStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #f7f7f5; --card: #ffffff; --text: #1d2126; --soft: #5d6570; --rule: #dfe1e4; --faint: #eef0f1;
  --accent: #1f5fbf; --warn: #8a4b00; --warn-back: #fff3df;
  --c0: #1f6fd0; --c1: #d1571b; --c2: #1b8a5a; --c3: #a63a9c; --c4: #9a7400; --c5: #0e8496; --c6: #c8324e; --c7: #5f6672;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #14171a; --card: #1c2025; --text: #e7e9ec; --soft: #9aa3ae; --rule: #353b43; --faint: #262b31;
    --accent: #7fb2ff; --warn: #ffc477; --warn-back: #36290f;
    --c0: #69a8ff; --c1: #ff9a62; --c2: #4fce96; --c3: #e58bdc; --c4: #e0ba45; --c5: #4fcadb; --c6: #ff8397; --c7: #b4bcc8;
  }
}
.s0 { --c: var(--c0) } .s1 { --c: var(--c1) } .s2 { --c: var(--c2) } .s3 { --c: var(--c3) }
.s4 { --c: var(--c4) } .s5 { --c: var(--c5) } .s6 { --c: var(--c6) } .s7 { --c: var(--c7) }
* { box-sizing: border-box }
body { margin: 0; background: var(--page); color: var(--text); font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif }
main { max-width: 1360px; margin: 0 auto; padding: 28px 20px 60px }
h1 { margin: 0 0 2px; font-size: 26px; line-height: 1.25; overflow-wrap: anywhere }
h2 { margin: 0 0 4px; font-size: 18px }
p { margin: 0 0 10px; max-width: 90ch }
.soft { color: var(--soft) }
section { margin-top: 22px; padding: 18px 20px 20px; background: var(--card); border: 1px solid var(--rule); border-radius: 10px }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(170px, 1fr)); gap: 14px 26px; margin: 18px 0 0 }
.facts div { border-top: 2px solid var(--rule); padding-top: 6px }
.facts dt { color: var(--soft); font-size: 13px }
.facts dd { margin: 0; font-weight: 600; overflow-wrap: anywhere }
.warn { margin: 14px 0 0; padding: 8px 12px; border-radius: 6px; background: var(--warn-back); color: var(--warn) }
.notes { margin: 14px 0 0; padding-left: 20px; color: var(--soft) }
.bar { display: flex; flex-wrap: wrap; gap: 8px 16px; align-items: center; margin: 10px 0 }
.bar > label { display: flex; flex-wrap: wrap; gap: 0 8px; align-items: center; max-width: 100% }
.choice { display: inline-flex; border: 1px solid var(--rule); border-radius: 7px; overflow: hidden }
.choice label { position: relative; cursor: pointer }
.choice input { position: absolute; opacity: 0; inset: 0; margin: 0; cursor: pointer }
.choice span { display: block; padding: 4px 12px }
.choice input:checked + span { background: var(--accent); color: var(--card) }
.choice input:focus-visible + span { outline: 2px solid var(--text); outline-offset: -3px }
.legend { display: flex; flex-wrap: wrap; gap: 6px 8px; margin: 8px 0 }
.legend button { display: inline-flex; gap: 8px; align-items: center; padding: 3px 10px; font: inherit; color: inherit; background: none;
  border: 1px solid var(--rule); border-radius: 7px; cursor: pointer; text-align: left }
.legend button[aria-pressed=false] { opacity: .45; text-decoration: line-through }
.swatch { width: 26px; height: 14px; flex: none }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(460px, 100%), 1fr)); gap: 14px 24px }
.plots figure { margin: 0; max-width: 720px }
figcaption { font-weight: 600; margin-bottom: 2px }
.plot { display: block; width: 100%; height: auto; font-size: 12.5px }
.plot text { fill: var(--soft) }
.plot text.axis { fill: var(--text); font-size: 13.5px }
.plot text.remark { font-size: 11.5px; font-style: italic; stroke: var(--card); stroke-width: 3px; paint-order: stroke }
.grid { stroke: var(--rule); stroke-width: 1 }
.grid.minor { stroke: var(--faint) }
.frame { fill: none; stroke: var(--soft); stroke-width: 1 }
.guide { stroke: var(--soft); stroke-width: 1.2; stroke-dasharray: 6 4 }
.line { fill: none; stroke: var(--c); stroke-width: 2; stroke-linejoin: round; stroke-linecap: round }
.mark { fill: var(--c); stroke: var(--card); stroke-width: 1.2 }
.plot .mark { cursor: pointer }
.plot .mark:hover { stroke: var(--text); stroke-width: 2 }
.band { fill: var(--c); fill-opacity: .16; stroke: none }
.whisker { stroke: var(--c); stroke-width: 2; stroke-opacity: .6 }
.off { display: none }
#tip { position: absolute; z-index: 9; max-width: 340px; padding: 7px 10px; border-radius: 6px; background: var(--text); color: var(--page);
  font-size: 13px; line-height: 1.4; white-space: pre-line; pointer-events: none; display: none }
.scroll { overflow-x: auto }
table { border-collapse: collapse; width: 100%; font-size: 14px; font-variant-numeric: tabular-nums }
th, td { padding: 5px 7px; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--faint) }
th:first-child, td:first-child { text-align: left; padding-left: 4px }
td:first-child { white-space: normal; min-width: 15em }
thead th { border-bottom: 2px solid var(--rule); vertical-align: bottom; padding: 0 }
thead button { width: 100%; padding: 5px 7px; font: inherit; font-weight: 600; color: inherit; background: none; border: 0; text-align: inherit; cursor: pointer; white-space: nowrap }
th:first-child button { padding-left: 4px }
thead button::after { content: "↕"; margin-left: 3px; opacity: .3 }
th[aria-sort=ascending] button::after { content: "↑"; opacity: 1 }
th[aria-sort=descending] button::after { content: "↓"; opacity: 1 }
tbody tr:hover { background: var(--faint) }
td .name { display: flex; gap: 8px; align-items: center }
select, #swap { font: inherit; color: inherit; background: var(--card); border: 1px solid var(--rule); border-radius: 7px; padding: 4px 8px; max-width: 100% }
#swap { cursor: pointer }
.stage { position: relative; margin: 6px auto 0; overflow: hidden; border-radius: 6px; background: #000; user-select: none; touch-action: pan-y }
.stage img { display: block; width: 100%; height: auto; image-rendering: auto }
.stage #left { position: absolute; inset: 0; height: 100% }
.stage .handle { position: absolute; top: 0; bottom: 0; width: 2px; margin-left: -1px; background: #fff; box-shadow: 0 0 4px #000; pointer-events: none }
.stage .handle::after { content: "↔"; position: absolute; top: 50%; left: 50%; transform: translate(-50%, -50%); width: 30px; padding: 4px 0; text-align: center; border-radius: 20px;
  background: #fff; color: #222; font-size: 17px; line-height: 1.3; white-space: nowrap; box-shadow: 0 0 5px rgba(0, 0, 0, .6) }
/* Half a thumb wider at both ends, so that the handle lies under the pointer everywhere. */
.stage input { position: absolute; top: 0; left: -8px; width: calc(100% + 16px); height: 100%; margin: 0; opacity: 0; cursor: ew-resize;
  appearance: none }
.stage input::-webkit-slider-thumb { appearance: none; width: 16px; height: 100% }
.stage input::-moz-range-thumb { width: 16px; height: 100%; border: 0 }
.stage input:focus-visible ~ .handle { outline: 2px solid var(--accent); outline-offset: 2px }
.badge { position: absolute; bottom: 8px; max-width: 46%; padding: 3px 8px; border-radius: 5px; background: rgba(0, 0, 0, .66); color: #fff; font-size: 13px;
  line-height: 1.35; pointer-events: none }
.badge.l { left: 8px } .badge.r { right: 8px; text-align: right }
.colorbar { max-width: 480px; margin: 12px auto 0; font-size: 13px; color: var(--soft) }
.colorbar .ramp { height: 14px; border-radius: 3px }
.colorbar .ends { display: flex; justify-content: space-between }
footer { margin-top: 26px; color: var(--soft); font-size: 13px }
a { color: var(--accent) }
@media (max-width: 640px) {
  main { padding: 16px 10px 40px }
  section { padding: 14px 12px 16px }
  /* Plots are drawn for twice this width. */
  .plot { font-size: 18px }
  .plot text.axis { font-size: 19px }
  .plot text.remark { font-size: 16px }
  th:first-child, td:first-child { position: sticky; left: 0; background: var(--card) }
  td:first-child { min-width: 10em; overflow-wrap: anywhere }
  td .swatch { display: none }
  .badge { font-size: 11px; max-width: 47% }
}
@media print { section { break-inside: avoid } }
)css";

}  // namespace lumirank::pages

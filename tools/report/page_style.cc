#include "tools/report/page_style.h"

namespace plumbline {

const char* const kPageStyle = R"css(
:root{color-scheme:light dark;--paper:#fbfbf9;--card:#fff;--ink:#1c2127;--soft:#5d6773;--line:#e3e5e8;--grid:#eceef0;
--c0:#3b6fb6;--c1:#2a9d7c;--c2:#a05fb0;--c3:#8a8420;--estimate:#d95f0e;--warn:#c8203f;
--solved:#2a9d7c;--partial:#e5a61c;--bypassed:#c8203f;--nothing:#eceef0}
@media(prefers-color-scheme:dark){:root{--paper:#14171b;--card:#1b1f25;--ink:#e7eaee;--soft:#98a3af;--line:#2c323a;
--grid:#262b32;--c0:#7aa9ea;--c1:#56c7a4;--c2:#cb93da;--c3:#cfc75e;--estimate:#ff9147;--warn:#ff6b81;
--solved:#3fb391;--partial:#e9b949;--bypassed:#ec5b72;--nothing:#2a2f37}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif}
main{max-width:1240px;margin:0 auto;padding:28px 20px 60px}
header{display:flex;flex-wrap:wrap;align-items:baseline;gap:6px 14px}
h1{font-size:28px;line-height:1.2;margin:0;overflow-wrap:anywhere}
h2{font-size:19px;margin:40px 0 4px}
p.note{margin:0 0 12px;color:var(--soft);max-width:80ch}
.badge{white-space:nowrap;font-weight:600;font-size:14px;padding:2px 12px;border-radius:99px;color:#fff;background:var(--soft)}
td .badge{font-size:12px;padding:1px 9px;white-space:nowrap}a{color:var(--c0)}td a{white-space:nowrap}.claims td a{white-space:normal}
.badge.ok{background:#1f7f63}.badge.failed{background:#a66c00}.badge.lost,.badge.error{background:#b81d3a}
.sub{color:var(--soft)}
.tiles{display:grid;grid-template-columns:repeat(5,minmax(0,1fr));gap:10px;margin:20px 0 0}
.tile{background:var(--card);border:1px solid var(--line);border-radius:10px;padding:10px 14px}
.tile b{display:block;font-size:22px;font-weight:600;font-variant-numeric:tabular-nums;white-space:nowrap}
.tile b small{font-size:14px;font-weight:400;color:var(--soft);white-space:normal}
.tile span{color:var(--soft);font-size:13px}
.checks{list-style:none;margin:16px 0 0;padding:0}
.checks li{padding:5px 12px;border-left:4px solid var(--solved);background:var(--card);margin-bottom:4px;overflow-wrap:anywhere}
.checks li.broken{border-color:var(--bypassed)}
.pair{display:grid;grid-template-columns:repeat(2,minmax(0,1fr));gap:14px}
.triple{display:grid;grid-template-columns:repeat(3,minmax(0,1fr));gap:14px}
figure{margin:0}
.card,.chart,.map{background:var(--card);border:1px solid var(--line);border-radius:10px;padding:12px 14px}
.pair>div>.chart{border-radius:0;border-bottom:0;padding-bottom:4px}
.pair>div>.chart:first-child{border-radius:10px 10px 0 0}
.pair>div>.chart.strips{border-bottom:1px solid var(--line);border-radius:0 0 10px 10px;padding-bottom:12px}
.map+.map{margin-top:14px}
figcaption{font-weight:600;font-size:14px}figcaption small{font-weight:400;color:var(--soft);font-size:13px}
.camera figcaption{font-weight:400;color:var(--soft);font-size:13px}
svg{display:block;width:100%;height:auto}
.map svg{max-height:620px;margin-top:6px}
svg text{font-size:13px;fill:var(--soft);font-family:inherit}
.map svg text{font-size:16px}
.axis{stroke:var(--soft);stroke-width:1;vector-effect:non-scaling-stroke}
.grid{stroke:var(--grid);stroke-width:1;vector-effect:non-scaling-stroke}
.line{fill:none;stroke-width:1.4;stroke-linecap:round;stroke-linejoin:round;vector-effect:non-scaling-stroke}
.c0{--hue:var(--c0)}.c1{--hue:var(--c1)}.c2{--hue:var(--c2)}.c3{--hue:var(--c3)}
.estimate{--hue:var(--estimate)}.warn{--hue:var(--warn)}
.truth{--hue:var(--ink)}.solved{--hue:var(--solved)}.partial{--hue:var(--partial)}.bypassed{--hue:var(--bypassed)}
.nothing{--hue:var(--nothing)}.bar{--hue:var(--c0)}
.line{stroke:var(--hue)}rect{fill:var(--hue)}
.line.warn{stroke-width:2.6}.map .line{stroke-width:2}.map .truth.line{stroke-width:3.2;opacity:.75}
.band{fill:var(--hue);opacity:.2}.dot{fill:var(--hue)}svg text.on-pale{fill:#2b1a10}svg text.on-dark{fill:#fff}
.scale,.whisker{stroke:var(--ink);stroke-width:1.6;vector-effect:non-scaling-stroke}
circle.start{fill:var(--card);stroke:var(--ink);stroke-width:2}circle.end{fill:var(--hue)}
.depth-lidar{--hue:#35d0ba}.depth-triangulated{--hue:#ffa62b}.depth-none{--hue:#9fb4ff}.outlier{--hue:#ff3b5c}
.feature{fill:none;stroke:var(--hue);stroke-width:1.4}.track{stroke:var(--hue);stroke-width:1;opacity:.7}
.camera svg{border-radius:8px;background:#000}
.legend{display:flex;flex-wrap:wrap;gap:2px 14px;color:var(--soft);font-size:13px;margin:2px 0 4px}
.legend i{display:inline-block;width:14px;height:10px;border-radius:3px;background:var(--hue);margin-right:6px}
.scroll{overflow-x:auto}.pair+.card,.tiles+.pair{margin-top:14px}
table{border-collapse:collapse;width:100%;font-size:14px}
th,td{text-align:left;padding:4px 10px 4px 0;border-bottom:1px solid var(--line);vertical-align:top;overflow-wrap:anywhere}
th{color:var(--soft);font-weight:500;white-space:nowrap}td.number,th.number{text-align:right;font-variant-numeric:tabular-nums}td.number{white-space:nowrap}
.columns{columns:2;column-gap:36px}.columns tr{break-inside:avoid}
pre{overflow-x:auto;font-size:13px;margin:8px 0 0}
details{margin-top:10px}summary{cursor:pointer}
@media(max-width:760px){main{padding:18px 12px 40px}h1{font-size:23px}h2{margin-top:32px}
.pair,.triple{grid-template-columns:minmax(0,1fr)}.columns{columns:1}
.tiles{grid-template-columns:repeat(2,minmax(0,1fr))}.tile{padding:8px 12px}.tile b{font-size:19px}
.card,.chart,.map{padding:10px}.wide table{min-width:760px}
.chart svg text{font-size:19px}.strips svg text{font-size:16.5px}.map svg text{font-size:32px}}
)css";

}  // namespace plumbline

#!/bin/sh
# SPDX-License-Identifier: MIT
# The page of a run in headless Chromium, where that is installed. Arguments: a program that swims, the source directory.
. "$2/tests/program.sh"
if ! command -v chromium >/dev/null; then
    echo "1..0 # SKIP chromium is not installed (tests/packages-browser.txt)"
    exit 0
fi

run --quiet --json --out results --current 0.1,0.05 --set duration_s=5
check "a run with a report: $(cat err)" eval '[ $code -eq 0 ] && [ -s results/report.html ]'

# browse FILE WIDTH: the page as scripts leave it in dom, what it says to the console in console.
browse() {
    timeout 100 chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run \
        --disable-background-networking --disable-component-update --disable-sync --user-data-dir="$work/profile" \
        --allow-file-access-from-files --enable-logging=stderr --virtual-time-budget=15000 --window-size="$2",900 \
        --dump-dom "file://$work/$1" >dom 2>log </dev/null
    grep 'CONSOLE' log >console || :
}

# said KEY: what the examination of the page left under the key.
said() {
    sed -n 's/.*<pre id="examined">\([^<]*\).*/\1/p' dom | tr ';' '\n' | sed -n "s/^$1=//p"
}

# The page in a frame as wide as a telephone, examined from outside: a window may not become that narrow.
{
    cat <<'END'
<!DOCTYPE html><meta charset="utf-8"><link rel="icon" href="data:,"><title>examination</title>
<iframe id="phone" src="results/report.html" style="width:390px;height:800px;border:0"></iframe><pre id="examined"></pre>
<script>
"use strict";
const phone = document.getElementById("phone");
const channel = c => { c /= 255; return c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; };
const light = rgb => 0.2126 * channel(rgb[0]) + 0.7152 * channel(rgb[1]) + 0.0722 * channel(rgb[2]);
const parts = text => (text.match(/[\d.]+/g) || []).map(Number);
const examine = () => {
  const view = phone.contentWindow, page = phone.contentDocument, said = [];
  const stage = page.getElementById("stage"), key = (k, on = stage) => on.dispatchEvent(new view.KeyboardEvent("keydown", { key: k, bubbles: true, cancelable: true }));
  const time = () => Number(stage.dataset.time), head = () => stage.querySelector("line").getAttribute("x1");
  said.push("plays=" + (time() > 0));
  said.push("overflow=" + (page.documentElement.scrollWidth - 390));
  key(" "); const paused = time(), there = head();
  said.push("pauses=" + (page.getElementById("scene-play").textContent === "Play"));
  key("ArrowRight"); said.push("steps=" + (time() > paused && head() !== there));
  const stepped = time(); key("ArrowLeft"); said.push("back=" + (time() < stepped));
  key("End"); said.push("end=" + time()); key("Home"); said.push("home=" + time());
  key("End", page.body); key(" ", page.body); said.push("elsewhere_scrolls=" + (time() === 0 && page.getElementById("scene-play").textContent === "Play"));
  const headed = [...page.querySelectorAll("table,svg[role=img]")].every(e => e.closest("#scene") || e.closest("section").querySelector("h2"));
  said.push("headed=" + headed, "named=" + [...page.querySelectorAll("[tabindex]")].every(e => e.getAttribute("aria-label")));
  const cursor = page.querySelector("svg[data-time] .cursor"); said.push("cursor=" + (cursor !== null));
  key("Home"); const robot = stage.querySelector("g.body0").getBoundingClientRect();
  said.push("robot=" + Math.round(100 * robot.width / stage.clientWidth));
  const figures = [...page.querySelectorAll("figure svg")].map(svg => svg.getBoundingClientRect());
  said.push("figures=" + (figures.length > 0 && figures.every(box => box.left >= 0 && box.right <= 390 && box.width > 300)));
  let least = 99, where = "";
  for (const element of page.querySelectorAll("h1,h2,p,th,td,a,caption,dt,dd,pre,button,label,li,summary")) {
    if (!element.textContent.trim() || element.closest("[hidden]")) continue;
    let ground = element;
    while (ground && parts(view.getComputedStyle(ground).backgroundColor)[3] === 0) ground = ground.parentElement;
    const one = light(parts(view.getComputedStyle(element).color)), other = ground ? light(parts(view.getComputedStyle(ground).backgroundColor)) : 1;
    const contrast = (Math.max(one, other) + 0.05) / (Math.min(one, other) + 0.05);
    if (contrast < least) { least = contrast; where = element.tagName; }
  }
  said.push("contrast=" + least.toFixed(2), "where=" + where);
  const ids = [...page.querySelectorAll("[id]")].map(e => e.id); said.push("twice=" + (ids.length - new Set(ids).size));
  said.push("unnamed=" + page.querySelectorAll("svg:not([aria-label]):not([aria-hidden])").length);
  said.push("elsewhere=" + page.querySelectorAll("[src],link[rel=stylesheet]").length);
  document.getElementById("examined").textContent = said.join(";");
};
// As soon as it plays, however slow the machine; at the latest after ten seconds.
const wait = tries => {
  const stage = phone.contentDocument.getElementById("stage");
  if (tries === 0 || (stage && Number(stage.dataset.time) > 0)) examine(); else setTimeout(() => wait(tries - 1), 100);
};
phone.onload = () => wait(100);
</script>
END
} >examine.html
for ground in light dark; do
    if [ $ground = dark ]; then # as the page is with prefers-color-scheme: dark
        sed 's/(prefers-color-scheme: dark)/all/' results/report.html >results/dark && mv results/dark results/report.html
    fi
    browse examine.html 900
    check "$ground: the console is clean: $(head -1 console)" [ ! -s console ]
    for what in plays pauses steps back cursor elsewhere_scrolls headed named figures; do
        check "$ground: $what" [ "$(said $what)" = true ]
    done
    check "$ground: Home and End: $(said home), $(said end)" eval '[ "$(said home)" = 0 ] && [ "$(said end)" = 5 ]'
    check "$ground: nothing is wider than the telephone: $(said overflow)" [ "$(said overflow)" -le 0 ]
    check "$ground: the robot is large enough to be seen: $(said robot) % of the width" [ "$(said robot)" -ge 25 ]
    check "$ground: contrast AA: $(said contrast) of $(said where)" awk "BEGIN { exit !($(said contrast) + 0 >= 4.5) }"
    check "$ground: every id is its own, every picture named, nothing from elsewhere: $(said twice) $(said unnamed) $(said elsewhere)" \
        [ "$(said twice)$(said unnamed)$(said elsewhere)" = 000 ]
done
browse 'results/report.html#t=2' 900
check "the page at a moment stays there" eval 'grep -q "data-time=\"2.000\"" dom && grep -q ">Play</button>" dom'
for key in speed_m_s power_W cost_of_transport_J_m energy_J; do
    value=$(number "$key")
    check "$key: the page has $value" grep -qF "<data value=\"$value\">" results/report.html
done
tap_done

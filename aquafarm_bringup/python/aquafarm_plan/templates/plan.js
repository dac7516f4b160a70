{# SPDX-License-Identifier: BSD-3-Clause #}
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const slider = document.getElementById("slider");
  const hazard = document.getElementById("hazard");
  const NS = "http://www.w3.org/2000/svg";
  const LEVELS = [10, 50, 90];

  const clockText = (seconds, offsetMin) => {
    const moment = new Date(data.start_ms + 1000 * seconds + 60000 * offsetMin);
    const day = ["Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"][moment.getUTCDay()];
    return `${day} ${moment.getUTCDate()}, ${moment.toISOString().slice(11, 16)}`;
  };

  // Entry of a list of [seconds, …] nearest to a time.
  const nearest = (list, seconds, key) => list.reduce(
    (best, one) => Math.abs(key(one) - seconds) < Math.abs(key(best) - seconds) ? one : best);

  // The members are a sample: no chance is 0 or 100 %.
  const percent = share => share < 0.005 ? "< 1 %" : share >= 0.995 ? "> 99 %" :
    `${Math.round(100 * share)} %`;

  function placeShip(route, seconds) {
    const path = route.path;
    let i = path.findIndex(point => point[2] > seconds);
    if (i === 0) i = 1;
    const last = path[path.length - 1];
    let [x, y] = last;
    let heading = 0;
    if (i > 0) {
      const [a, b] = [path[i - 1], path[i]];
      const share = Math.min(1, Math.max(0, (seconds - a[2]) / Math.max(1, b[2] - a[2])));
      x = a[0] + share * (b[0] - a[0]);
      y = a[1] + share * (b[1] - a[1]);
      heading = Math.atan2(b[0] - a[0], a[1] - b[1]) * 180 / Math.PI;
    }
    const ship = document.getElementById(`ship${route.ship}`);
    ship.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
    ship.querySelector("path").setAttribute("transform", `rotate(${heading.toFixed(0)})`);
  }

  function markDevices(seconds) {
    document.querySelectorAll(".device[id]").forEach(one => one.classList.remove("aboard", "home"));
    for (const route of data.routes) {
      for (const [when, action, device, delivered] of route.events) {
        if (when > seconds) continue;
        if (action === "fetch") document.getElementById(`device${device}`).classList.add("aboard");
        for (const one of delivered) document.getElementById(`device${one}`).classList.add("home");
      }
    }
  }

  function drawHazard(seconds) {
    hazard.replaceChildren();
    drawOutlines(seconds);
    document.getElementById("hatching").hidden = !hazard.childElementCount;
  }

  function drawOutlines(seconds) {
    if (!data.hazard.length) return;
    const frame = nearest(data.hazard, seconds, one => one.s);
    frame.rings.map((outlines, ring) => [outlines, ring]).reverse().forEach(([outlines, ring]) => {
      outlines.forEach((outline, level) => {
        if (!outline) return;
        const path = document.createElementNS(NS, "path");
        path.setAttribute("d", outline);
        path.setAttribute("class", `iso ring${ring} l${LEVELS[level]}`);
        if (LEVELS[level] === 50) path.style.fill = `url(#hatch${Math.min(ring, 3)})`;
        hazard.append(path);
      });
    });
  }

  function show() {
    const seconds = Number(slider.value);
    const share = data.end_s > 0 ? seconds / data.end_s : 0;
    document.getElementById("cursor").setAttribute(
      "transform", `translate(${(share * (data.right - data.left)).toFixed(1)} 0)`);
    document.getElementById("clock").textContent =
      `${clockText(seconds, data.offset_min)} ${data.zone} (${clockText(seconds, 0)} UTC)`;
    let state = data.no_rings;
    if (data.timeline.length) {
      const chances = nearest(data.timeline, seconds, one => one[0])[1];
      state = "Over the ranch: " + data.rings.map((name, i) =>
        `${name} ${percent(chances[i])}`).reverse().join(", ") + ".";
    }
    document.getElementById("state").textContent = state;
    slider.setAttribute("aria-valuetext", document.getElementById("clock").textContent);
    for (const route of data.routes) placeShip(route, seconds);
    markDevices(seconds);
    drawHazard(seconds);
  }

  slider.addEventListener("input", show);
  show();
})();

// SPDX-License-Identifier: BSD-3-Clause
// Draws the charts of CURVES; a zoom applies to all of them.
window.charts = [];
// Runs also differ by their dashes, so that a print without colours shows which is which.
const LINES = [["dotted", [2, 3]], ["dashed", [8, 4]], ["solid", [1, 0]]];  // of references
const DASHES = [null, [9, 4], [2, 3], [12, 4, 2, 4], [5, 5], [1, 6], [14, 6]];
// Width for the marks of greedy play at the right edge [pixels]. All charts have the same episodes.
const MARKS = Math.max(...CURVES.charts.map(chart => (chart.marks || []).length));
// Distance of two marks; up to four have their value below or above them.
const STEP = MARKS <= 4 ? 40 : 20;
const PAD = MARKS ? Math.max(56, 12 + STEP * MARKS) : 0;  // has space for "greedy"
let moving = false;
for (const chart of CURVES.charts) {
  const unit = chart.bend;
  const onScale = value => value === null ? null : toScale(value, unit);
  const returns = chart.id.startsWith("curve_return");
  window.charts.push(new Dygraph(document.getElementById(chart.id),
    chart.rows.map(([episode, ...means]) => [episode, ...means.map(onScale)]), {
    labels: CURVES.labels,
    colors: CURVES.colours,
    series: Object.fromEntries(CURVES.labels.slice(1).map(
      (label, i) => [label, {strokePattern: DASHES[i % DASHES.length]}])),
    labelsDiv: chart.id + "_legend",
    legend: CURVES.labels.length > 2 ? "always" : "onmouseover",  // a tile names one run
    labelsSeparateLines: false,
    connectSeparatedPoints: true,
    strokeWidth: 2,
    xRangePad: PAD,
    xlabel: `episode (mean of the last ${CURVES.window})`,
    gridLineColor: "rgba(128, 128, 128, 0.3)",
    axisLabelColor: "currentColor",
    axisLabelWidth: 60,
    digitsAfterDecimal: 3,
    axes: {
      x: {axisLabelFormatter: episode => inWords(episode, 0)},
      y: returns ? {
        valueFormatter: y => inWords(fromScale(y, unit), 1),
        ticker: (low, high) => ticks(fromScale(low, unit), fromScale(high, unit)).map(
          value => ({v: toScale(value, unit), label: inWords(value, 0)})),
      } : {},
    },
    valueRange: chart.range || (returns ? visible(chart).map(onScale) : null),
    underlayCallback: (canvas, area, dygraph) => {
      if (unit) shade(canvas, area, dygraph);
      reference(canvas, area, dygraph, chart.lines || [], onScale);
      mark(canvas, area, dygraph, chart.marks || [], onScale);
    },
    highlightSeriesOpts: {strokeWidth: 3},
    zoomCallback: (from, to) => {
      if (moving) return;
      moving = true;
      const isPart = window.charts.some(one => one.isZoomed("x") &&
        one.xAxisRange()[0] === from && one.xAxisRange()[1] === to);
      for (const other of window.charts) {
        const [first, last] = other.xAxisExtremes();
        if (isPart && (to <= first || from >= last)) continue;  // it has no curve there
        if (other.xAxisRange()[0] !== from || other.xAxisRange()[1] !== to) {
          other.updateOptions({dateWindow: isPart ? [from, to] : null});
        }
      }
      moving = false;
    },
  }));
}

// The tile of a run has the colour of its curve.
for (const tile of document.querySelectorAll(".tile.own")) {
  const run = CURVES.labels.indexOf(tile.firstElementChild.textContent) - 1;
  if (run >= 0) tile.style.setProperty("--own", CURVES.colours[run]);
}

// Maps a value to a scale that is linear above 0 and logarithmic below. If `unit` is null, the
// whole scale is linear.
function toScale(value, unit) {
  return unit && value < 0 ? -unit * Math.log1p(-value / unit) : value;
}

function fromScale(y, unit) {
  return unit && y < 0 ? unit * (1 - Math.exp(-y / unit)) : y;
}

// Writes a value without decimals, except a success rate just below 100 %, which must not become
// "100". Returns of this size are rounded down to one decimal, too.
function inWhole(value) {
  return value > 99 && value < 100 ? inWords(Math.floor(10 * value) / 10, 1) : inWords(value, 0);
}

function inWords(value, digits) {
  return value.toFixed(digits).replace("-", "\u2212").replace(/\B(?=(\d{3})+(?!\d))/g,
    digits ? "" : ",");
}

// Returns round values in a range: at most seven from 0 on, and below 0 powers of ten and three
// times these.
function ticks(low, high) {
  if (low >= 0 || high <= 0) return steps(low, high);
  const below = [];
  for (let value = 1; value <= -low; value *= 10) {
    for (const tick of [-value, -3 * value]) if (tick >= low && tick < -high / 4) below.push(tick);
  }
  return [...below, ...steps(0, high)];
}

function steps(low, high) {
  const power = 10 ** Math.floor(Math.log10((high - low) / 5 || 1));
  const step = [1, 2, 5, 10].map(factor => factor * power).find(one => (high - low) / one <= 6);
  const found = [];
  for (let at = Math.ceil(low / step); at * step <= high; ++at) found.push(at * step);
  return found;
}

// Shades the logarithmic part of a scale.
function shade(canvas, area, dygraph) {
  const zero = Math.min(Math.max(dygraph.toDomYCoord(0), area.y), area.y + area.h);
  const height = area.y + area.h - zero;
  canvas.save();
  canvas.fillStyle = "rgba(128, 128, 128, 0.09)";
  canvas.fillRect(area.x, zero, area.w, height);
  canvas.font = `12px ${getComputedStyle(document.body).fontFamily}`;
  canvas.fillStyle = "rgba(128, 128, 128, 1)";
  canvas.textAlign = "right";
  if (height > 40) canvas.fillText("logarithmic below 0", area.x + area.w - PAD - 8, zero + 18);
  canvas.restore();
}

// Returns how many points of the curves lie in a box.
function pointsIn(dygraph, left, right, top, bottom) {
  let count = 0;
  for (let row = 0; row < dygraph.numRows(); ++row) {
    const x = dygraph.toDomXCoord(dygraph.getValue(row, 0));
    if (x < left || x > right) continue;
    for (let run = 1; run < dygraph.numColumns(); ++run) {
      const value = dygraph.getValue(row, run);
      const y = value === null ? NaN : dygraph.toDomYCoord(value);
      if (y > top && y < bottom) ++count;
    }
  }
  return count;
}

// Draws a line with a name for each reference in the range of a chart. Names of lines that are
// close to each other are written side by side, with the styles of the lines if there is space.
function reference(canvas, area, dygraph, lines, onScale) {
  const style = getComputedStyle(document.body);
  const seen = lines
    .map((line, i) => ({...line, y: dygraph.toDomYCoord(onScale(line.value)), style: LINES[i % 3]}))
    .filter(line => line.y >= area.y && line.y <= area.y + area.h)
    .sort((a, b) => a.y - b.y);
  canvas.save();
  canvas.strokeStyle = canvas.fillStyle = style.color;
  canvas.font = `13px ${style.fontFamily}`;
  const names = [];
  for (const line of seen) {
    canvas.setLineDash(line.style[1]);
    canvas.beginPath();
    canvas.moveTo(area.x, line.y);
    canvas.lineTo(area.x + area.w, line.y);
    canvas.stroke();
    const last = names[names.length - 1];
    if (last && line.y - last.y < 16) {
      last.low = line.y;
      last.lines.push(line);
    } else {
      names.push({y: line.y, low: line.y, lines: [line]});
    }
  }
  for (const name of names) {
    const [plain, styled] = [false, true].map(isStyled => name.lines.map(line =>
      `${line.label} ${line.text}${isStyled ? ` (${line.style[0]})` : ""}`).join(", "));
    const isStyled = name.lines.length > 1 && canvas.measureText(styled).width < area.w - PAD - 12;
    const text = isStyled ? styled : plain;
    // At the left or the right end, above or below its line, where it covers the fewest points.
    const width = canvas.measureText(text).width + 12;
    const end = area.x + area.w - PAD;
    const places = [[area.x, -5], [end - width, -5], [area.x, 16], [end - width, 16]]
      .map(([x, by]) => [x, by + (by > 0 ? name.low : name.y)])
      .filter(([, y]) => y - 14 > area.y && y + 4 < area.y + area.h)
      .map(([x, y]) => ({x, y, points: pointsIn(dygraph, x, x + width, y - 14, y + 4)}));
    if (!places.length) continue;
    const best = places.reduce((a, b) => b.points < a.points ? b : a);
    canvas.fillText(text, best.x + 6, best.y);
  }
  canvas.restore();
}

// Draws the mean of greedy play of each run with its interval at the right edge, in a strip
// labelled "greedy play".
function mark(canvas, area, dygraph, marks, onScale) {
  const at = value => dygraph.toDomYCoord(onScale(value));
  if (!marks.length) return;
  canvas.save();
  const pad = PAD * area.w / (area.w + 2 * PAD);  // dygraphs scales the space of xRangePad
  const strip = {left: area.x + area.w - pad + 2, width: pad - 2};
  const middle = strip.left + strip.width / 2;
  canvas.fillStyle = "rgba(128, 128, 128, 0.16)";
  canvas.fillRect(strip.left, area.y, strip.width, area.h);
  const style = getComputedStyle(document.body);
  canvas.font = `12px ${style.fontFamily}`;
  canvas.fillStyle = style.color;
  canvas.textAlign = "center";
  canvas.fillText("greedy", middle, area.y + area.h - 40);  // above RANDOM
  canvas.fillText("play", middle, area.y + area.h - 26);
  canvas.lineWidth = 2;
  let below = 0;
  marks.forEach(([mean, low, high], i) => {
    if (mean === null) return;
    const x = middle + STEP * (i - (marks.length - 1) / 2);
    canvas.strokeStyle = canvas.fillStyle = CURVES.colours[i];
    if (at(mean) > area.y + area.h) {  // below an enlarged part
      const text = `${inWords(mean, 0)} \u2193`;
      const half = canvas.measureText(text).width / 2 + 3;  // it stays inside the strip
      canvas.fillText(text,
        Math.min(Math.max(x, strip.left + half), strip.left + strip.width - half),
        area.y + area.h - 8 - 14 * (below % 2));
      below += 1;
      return;
    }
    canvas.beginPath();
    canvas.arc(x, at(mean), 4, 0, 2 * Math.PI);
    canvas.fill();
    if (STEP > 20) {  // below the interval, because references are above; else above "greedy"
      const below = at(low ?? mean) + 17;
      canvas.fillText(inWhole(mean), x,
        below < area.y + area.h - 54 ? below : at(high ?? mean) - 8);
    }
    if (low === null) return;
    canvas.beginPath();
    canvas.moveTo(x, at(low));
    canvas.lineTo(x, at(high));
    for (const end of [low, high]) {
      canvas.moveTo(x - 5, at(end));
      canvas.lineTo(x + 5, at(end));
    }
    canvas.stroke();
  });
  canvas.restore();
}

// Returns the range of the returns, the lines of references and the marks. On a linear scale it
// leaves out the lowest tenth of the curves, as returns of the first episodes are far below.
function visible(chart) {
  const values = chart.rows.flatMap(row => row.slice(1)).filter(value => value !== null)
    .sort((a, b) => a - b);
  const isEnd = chart.id === "curve_return_end";
  const others = [...chart.lines.map(line => line.value),
    ...chart.marks.flat().filter(value => value !== null)]
    .filter(value => !isEnd || value >= values[0]);
  const first = chart.bend || isEnd ? 0 : Math.floor(0.1 * (values.length - 1));
  const low = Math.min(values[first], ...others);
  const high = Math.max(values[values.length - 1], ...others);
  const margin = 0.08 * (high - low || 1);
  return chart.bend ? [1.3 * low, 1.16 * high] : [low - margin, high + margin];
}

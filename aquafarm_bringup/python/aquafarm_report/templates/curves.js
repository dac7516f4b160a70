// SPDX-License-Identifier: BSD-3-Clause
// Draws the charts of CURVES; an enlarged part applies to all of them.
window.charts = [];
// Runs differ by their dashes too, so that they can be told apart in a print without colours.
const DASHES = [null, [9, 4], [2, 3], [12, 4, 2, 4], [5, 5], [1, 6], [14, 6]];
let moving = false;
for (const chart of CURVES.charts) {
  const returns = chart.id.startsWith("curve_return");
  window.charts.push(new Dygraph(document.getElementById(chart.id), chart.rows, {
    labels: CURVES.labels,
    colors: CURVES.colours,
    series: Object.fromEntries(CURVES.labels.slice(1).map(
      (label, i) => [label, {strokePattern: DASHES[i % DASHES.length]}])),
    labelsDiv: chart.id + "_legend",
    legend: "always",
    labelsSeparateLines: false,
    connectSeparatedPoints: true,
    strokeWidth: 2,
    xlabel: "episode",
    gridLineColor: "rgba(128, 128, 128, 0.3)",
    axisLabelColor: "currentColor",
    axisLabelWidth: 60,
    digitsAfterDecimal: returns ? 1 : 3,
    valueRange: chart.range || (returns ? visible(chart) : null),
    underlayCallback: (canvas, area, dygraph) => reference(canvas, area, dygraph, chart.lines || []),
    highlightSeriesOpts: {strokeWidth: 3},
    zoomCallback: (from, to) => {
      if (moving) return;
      moving = true;
      for (const other of window.charts) {
        if (other.xAxisRange()[0] !== from || other.xAxisRange()[1] !== to) {
          other.updateOptions({dateWindow: [from, to]});
        }
      }
      moving = false;
    },
  }));
}

// Draws a dashed line with a name for each reference in the range of a chart; names above each other
// are written once, with commas.
function reference(canvas, area, dygraph, lines) {
  const seen = lines.map(line => ({...line, y: dygraph.toDomYCoord(line.value)}))
    .filter(line => line.y >= area.y && line.y <= area.y + area.h)
    .sort((a, b) => a.y - b.y);
  canvas.save();
  canvas.strokeStyle = canvas.fillStyle = getComputedStyle(document.body).color;
  canvas.font = "13px sans-serif";
  canvas.textAlign = "right";
  canvas.setLineDash([6, 4]);
  const names = [];
  for (const line of seen) {
    canvas.beginPath();
    canvas.moveTo(area.x, line.y);
    canvas.lineTo(area.x + area.w, line.y);
    canvas.stroke();
    const name = `${line.label} ${line.value.toFixed(1)}`;
    const last = names[names.length - 1];
    if (last && line.y - last.y < 16) last.text += `, ${name}`;
    else names.push({y: line.y, text: name});
  }
  for (const name of names) {
    const above = name.y - area.y > 18;
    canvas.fillText(name.text, area.x + area.w - 6, name.y + (above ? -5 : 26));
  }
  canvas.restore();
}

// The range of returns with the lines of references, without the lowest tenth of the curves: returns
// of the first episodes are far below.
function visible(chart) {
  const values = chart.rows.flatMap(row => row.slice(1)).filter(value => value !== null)
    .sort((a, b) => a - b);
  const lines = (chart.lines || []).map(line => line.value);
  const low = Math.min(values[Math.floor(0.1 * (values.length - 1))], ...lines);
  const high = Math.max(values[values.length - 1], ...lines);
  const margin = 0.08 * (high - low || 1);
  return [low - margin, high + margin];
}

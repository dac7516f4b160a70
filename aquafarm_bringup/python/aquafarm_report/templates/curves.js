// SPDX-License-Identifier: BSD-3-Clause
// Draws the charts of CURVES; an enlarged part applies to all of them.
window.charts = [];
// Runs differ by their dashes too, so that they can be told apart in a print without colours.
const DASHES = [null, [9, 4], [2, 3], [12, 4, 2, 4], [5, 5], [1, 6], [14, 6]];
let moving = false;
for (const chart of CURVES.charts) {
  const returns = chart.id === "curve_return";
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
    valueRange: returns ? visible(chart.rows) : null,
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

// The range of returns without the lowest tenth: returns of the first episodes are far below.
function visible(rows) {
  const values = rows.flatMap(row => row.slice(1)).filter(value => value !== null)
    .sort((a, b) => a - b);
  const low = values[Math.floor(0.1 * (values.length - 1))];
  const high = values[values.length - 1];
  const margin = 0.08 * (high - low || 1);
  return [low - margin, high + margin];
}

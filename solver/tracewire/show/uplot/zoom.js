// Draws the curves of each figure of a report in place of its picture. Drag to zoom.
(function () {
  "use strict";
  var LABEL = 22;  // pixels
  var APART = 18;  // pixels between two numbers at an upright axis: a low panel has some, too
  var HINT = "Drag over a panel to zoom, double-click to see all. Click on a name to hide its curve.";

  function numbers(text) {
    var bytes = Uint8Array.from(atob(text), function (c) { return c.charCodeAt(0); });
    var view = new DataView(bytes.buffer), found = [];
    for (var n = 0; n < bytes.length; n += 4) {
      var value = view.getFloat32(n, true);
      found.push(isFinite(value) ? value : null);
    }
    return found;
  }

  // without the commas of a locale
  function plain(u, splits) {
    return splits.map(function (v) { return String(+v.toPrecision(10)); });
  }

  function faded(color, alpha) {
    return color + ("0" + Math.round(255 * alpha).toString(16)).slice(-2);
  }

  function text(tag, kind, words, parent) {
    var made = document.createElement(tag);
    made.className = kind;
    made.textContent = words;
    parent.appendChild(made);
    return made;
  }

  function line(context, look, x0, y0, x1, y1) {
    context.strokeStyle = faded(look.color, look.alpha === undefined ? 1 : look.alpha);
    context.lineWidth = (look.width || 1) * devicePixelRatio;
    context.setLineDash((look.dash || []).map(function (d) { return d * devicePixelRatio; }));
    context.beginPath();
    context.moveTo(x0, y0);
    context.lineTo(x1, y1);
    context.stroke();
    context.setLineDash([]);
  }

  // draws inside of the box of a panel; `paint` gets the places of a time and of a value in pixels
  function inside(paint) {
    return function (u) {
      u.ctx.save();
      u.ctx.beginPath();
      u.ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
      u.ctx.clip();
      paint(u.ctx, u.bbox, function (v) { return u.valToPos(v, "x", true); },
            function (v) { return u.valToPos(v, "y", true); });
      u.ctx.restore();
    };
  }

  // what stands behind the grid
  function bands(panel) {
    return inside(function (c, box, x, y) {
      panel.bands.forEach(function (b) {
        c.fillStyle = faded(b.color, b.alpha);
        if (b.upright) c.fillRect(x(b.from), box.top, Math.max(x(b.to) - x(b.from), 1), box.height);
        else c.fillRect(box.left, y(b.to), box.width, y(b.from) - y(b.to));
      });
    });
  }

  // what stands on the grid, behind the curves
  function marks(panel) {
    return inside(function (c, box, x, y) {
      var right = box.left + box.width, low = box.top + box.height;
      panel.levels.forEach(function (l) { line(c, l, box.left, y(l.at), right, y(l.at)); });
      panel.instants.forEach(function (i) { line(c, i, x(i.at), box.top, x(i.at), low); });
      panel.bars.forEach(function (group) {
        c.fillStyle = faded(group.color, group.alpha);
        group.at.forEach(function (b) {
          c.fillRect(x(b[0]), Math.min(y(b[2]), y(b[3])), Math.max(x(b[1]) - x(b[0]), 1.5),
                     Math.abs(y(b[3]) - y(b[2])));
        });
      });
      panel.marks.forEach(function (group) {
        group.at.forEach(function (m) { line(c, group, x(m[0]), y(m[1]), x(m[0]), y(m[2])); });
      });
    });
  }

  function options(panel, last, gutter, key) {
    var rows = panel.rows;
    var whole = function (u) {
      return !u.scales || u.scales.x.min === null ||
        (u.scales.x.min <= panel.x[0] && u.scales.x.max >= panel.x[1]);
    };
    var range = function (u, least, most) {
      if (rows || least === null || whole(u)) return panel.y;
      return uPlot.rangeNum(least, most, 0.1, true);
    };
    var yScale = {range: range, dir: panel.down ? -1 : 1};
    var yAxis = {size: gutter, space: APART, values: plain, stroke: "#444", grid: {stroke: "#e6e6e6", width: 1, show: !rows}};
    if (rows) {
      yAxis.size = gutter + LABEL;
      yAxis.splits = function () { return rows.map(function (_, n) { return n; }); };
      yAxis.values = function () { return rows; };
      yAxis.ticks = {show: false};
    } else {
      yAxis.label = panel.label;
      yAxis.labelSize = LABEL;
      yAxis.labelFont = "12px sans-serif";
    }
    var made = {
      width: 800,
      height: Math.round(96 * panel.inches) + (last ? 68 : 44),
      pxAlign: false,
      cursor: {sync: {key: key, scales: ["x", null]}, drag: {x: true, y: false}, points: {size: 6}},
      legend: {show: !rows, live: true},
      scales: {x: {time: false, range: function (u, a, b) { return [a, b]; }}, y: yScale},
      axes: [
        {stroke: "#444", grid: {stroke: "#e6e6e6", width: 1}, values: plain, size: last ? 32 : 26,
         label: last ? "t [s]" : null, labelSize: 18, labelFont: "12px sans-serif"},
        yAxis
      ],
      series: [{label: "t", value: function (u, v) { return v === null ? "" : v.toPrecision(6); }}],
      hooks: {drawClear: [bands(panel)], drawAxes: [marks(panel)]}
    };
    panel.lines.forEach(function (l) {
      made.series.push({
        label: l.label,
        stroke: faded(l.color, l.alpha),
        width: l.width,
        dash: l.dash.length ? l.dash : undefined,
        points: {show: l.dots, size: 3, fill: faded(l.color, l.alpha), width: 0},
        paths: l.dots ? function () { return null; } : undefined,
        value: function (u, v) { return v === null || v === undefined ? "" : v.toPrecision(5); }
      });
    });
    return made;
  }

  function draw(figure, number) {
    var data = JSON.parse(figure.querySelector("script.curves").textContent);
    var arrays = data.arrays.map(numbers);
    var holder = document.createElement("div");
    holder.className = "zoom";
    var longest = 0;
    data.panels.forEach(function (panel) {
      (panel.rows || []).forEach(function (row) { longest = Math.max(longest, row.length); });
    });
    var gutter = Math.max(68, Math.min(200, 7 * longest + 12));
    var plots = [], moving = false;
    figure.insertBefore(holder, figure.firstChild);
    try {
      data.panels.forEach(function (panel, n) {
        if (panel.title) text("p", "name", panel.title, holder);
        var own = JSON.stringify(panel.x);
        var made = options(panel, n === data.panels.length - 1, gutter, "f" + number + own);
        var tables = panel.lines.map(function (l) { return [arrays[l.x], arrays[l.y]]; });
        if (!tables.length) tables = [[panel.x.slice(), panel.x.map(function () { return null; })]];
        if (!panel.lines.length) made.series.push({label: "", show: false});
        made.scales.x.min = panel.x[0];
        made.scales.x.max = panel.x[1];
        made.width = figure.clientWidth;
        made.hooks.setScale = [function (u, scale) {
          if (scale !== "x" || moving || !u.ready) return;
          moving = true;
          plots.forEach(function (other) {
            if (other.own === own && other.plot !== u) {
              other.plot.setScale("x", {min: u.scales.x.min, max: u.scales.x.max});
            }
          });
          moving = false;
        }];
        made.hooks.ready = [function (u) {
          u.ready = true;
          u.setScale("x", {min: panel.x[0], max: panel.x[1]});
          // all that the picture shows, and not only what the curves reach
          u.over.addEventListener("dblclick", function () {
            setTimeout(function () { u.setScale("x", {min: panel.x[0], max: panel.x[1]}); }, 0);
          });
        }];
        plots.push({own: own, plot: new uPlot(made, uPlot.join(tables), holder)});
      });
      text("p", "hint", HINT, holder);
    } catch (error) {  // the picture stays
      holder.remove();
      throw error;
    }
    figure.querySelector("img").style.display = "none";
    figure.plots = plots;
    window.addEventListener("resize", function () {
      plots.forEach(function (one) {
        one.plot.setSize({width: figure.clientWidth, height: one.plot.height});
      });
    });
  }

  Array.prototype.forEach.call(document.querySelectorAll("figure.curves"), draw);
}());

// The parts of a scene on a canvas, one function for each kind: c is the canvas, k the number of the sample.

const EDGE = "#333333";

function at(one, key, k, value, look) {
  const [x, y] = one.points[key];
  return [look.x(value(x, k)), look.y(value(y, k))];
}

function size(one, key, k, value) {
  return key in one.sizes ? value(one.sizes[key], k) : undefined;
}

function line(c, points, color, width) {
  c.strokeStyle = color;
  c.lineWidth = width;
  c.beginPath();
  points.forEach(([x, y], n) => (n ? c.lineTo(x, y) : c.moveTo(x, y)));
  c.stroke();
}

// points (x, y) in m around a middle, turned to the left by an angle in rad
function turned(points, [x, y], angle, scale) {
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  return points.map(([a, b]) => [x + (a * cos - b * sin) * scale, y - (a * sin + b * cos) * scale]);
}

function rod(c, one, k, value, look) {
  const ends = [at(one, "from", k, value, look), at(one, "to", k, value, look)];
  c.lineCap = "round";
  line(c, ends, one.color, 3);
  for (const [x, y] of ends) {
    c.beginPath();
    c.arc(x, y, 3, 0, 2 * Math.PI);
    c.fillStyle = "white";
    c.fill();
    c.lineWidth = 1.2;
    c.stroke();
  }
}

function spring(c, one, k, value, look) {
  const [from, to] = [at(one, "from", k, value, look), at(one, "to", k, value, look)];
  const way = [to[0] - from[0], to[1] - from[1]];
  const length = Math.hypot(...way);
  const normal = length ? [-way[1] / length, way[0] / length] : [0, 0];
  const wide = (size(one, "width", k, value) ?? 0.05 * look.size) * look.scale;
  const quarters = 4 * Math.round(value(one.sizes.coils, 0));
  const points = [from];
  for (let n = 0; n <= quarters; n++) {
    const along = 0.1 + 0.8 * n / quarters;
    const across = [0, 0.5, 0, -0.5][n % 4] * wide;
    points.push([from[0] + along * way[0] + across * normal[0], from[1] + along * way[1] + across * normal[1]]);
  }
  c.lineJoin = "round";
  line(c, [...points, to], one.color, 1.4);
}

function disc(c, one, k, value, look) {
  const [x, y] = at(one, "at", k, value, look);
  const radius = Math.abs(size(one, "radius", k, value)) * look.scale;
  c.beginPath();
  c.arc(x, y, radius, 0, 2 * Math.PI);
  c.fillStyle = one.color;
  c.fill();
  c.strokeStyle = EDGE;
  c.lineWidth = 1;
  c.stroke();
  const angle = size(one, "angle", k, value);
  if (angle === undefined) return;
  const [a, b] = [0.85 * radius * Math.cos(angle), 0.85 * radius * Math.sin(angle)];
  line(c, [[x - a, y + b], [x + a, y - b]], "white", 1.5);
}

function box(c, one, k, value, look) {
  const [w, h] = [size(one, "width", k, value) / 2, size(one, "height", k, value) / 2];
  const corners = turned([[-w, -h], [w, -h], [w, h], [-w, h]], at(one, "at", k, value, look),
    size(one, "angle", k, value), look.scale);
  c.beginPath();
  corners.forEach(([x, y], n) => (n ? c.lineTo(x, y) : c.moveTo(x, y)));
  c.closePath();
  c.fillStyle = one.color;
  c.fill();
  c.strokeStyle = EDGE;
  c.lineWidth = 1;
  c.stroke();
}

function ground(c, one, k, value, look) {
  const length = size(one, "length", k, value);
  const angle = size(one, "angle", k, value);
  const middle = at(one, "at", k, value, look);
  const hatches = 24;
  const deep = Math.min(0.03 * look.size, 1.5 * Math.abs(length) / hatches);
  line(c, turned([[-length / 2, 0], [length / 2, 0]], middle, angle, look.scale), one.color, 2);
  for (let n = 1; n <= hatches; n++) {
    const x = (n / hatches - 0.5) * length;
    line(c, turned([[x, 0], [x - deep, -deep]], middle, angle, look.scale), one.color, 0.8);
  }
}

function trace(c, one, k, value, look) {
  const seconds = size(one, "seconds", 0, value) ?? Infinity;
  const points = [];
  for (let n = k; n >= 0 && look.t[n] >= look.t[k] - seconds; n--) points.push(at(one, "at", n, value, look));
  c.lineJoin = "round";
  c.globalAlpha = 0.8;
  line(c, points, one.color, 1);
  c.globalAlpha = 1;
}

export const DRAW = {rod, spring, disc, box, ground, trace};

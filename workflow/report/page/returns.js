// a wall that is drawn goes onto the returns that lie along it: the side of it that was seen
const returns = (() => {
  const { cross, minus, plus, unit } = shapes;
  const reach = 0.15; // metres that a line may be moved by: as far as a tap misses, and as walls are thick
  const on = 0.03; // metres from a line that its returns lie: their noise, and half of what thin walls are thick
  const steep = Math.tan((10 * Math.PI) / 180); // of what was drawn, that a line may be turned by
  const cell = 0.1; // metres along a line that have a return or none: points of the page are nearer on a wall
  const [covered, least] = [0.5, 10]; // share of its length, and returns: fewer are anybody's
  const alike = 0.75; // of the returns of a wall's side, that its other side has at least
  const skirting = 0.2; // metres above the floor, and below the ceiling, where returns may be theirs
  const touching = 0.002; // metres: places that are drawn are exact to one millimetre
  const crossing = 0.5; // sine of the angle, at least, of walls that do not go on along each other

  // returns beside a line: metres along it and to its left
  function beside([a, b], xyz, [low, high]) {
    const [[ux, uy], length] = [unit([a, b]), Math.hypot(...minus(b, a))];
    const found = [];
    for (let i = 0; i < xyz.length; i += 3) {
      const [x, y, z] = [xyz[i] - a[0], xyz[i + 1] - a[1], xyz[i + 2]];
      const [along, left] = [x * ux + y * uy, ux * y - uy * x];
      if (along >= 0 && along <= length && Math.abs(left) <= reach + on && z >= low && z <= high) found.push([along, left]);
    }
    return found;
  }
  const near = (all, [off, rise]) => all.filter(([along, left]) => Math.abs(left - off - rise * along) <= on);
  // of a thick wall both sides are near: the line that most returns lie on, not one between them
  function search(all, length) {
    const offs = Array.from({ length: 13 }, (_, i) => (i / 6 - 1) * reach);
    const lines = offs.flatMap((from) => offs.map((to) => [from, (to - from) / length])).filter(([, rise]) => Math.abs(rise) <= steep);
    return lines.map((line) => [line, near(all, line).length]).reduce((best, each) => (each[1] > best[1] ? each : best))[0];
  }
  // the nearer side of the same wall, where both are seen about alike
  function choose(all, length, line) {
    const shifts = Array.from({ length: 31 }, (_, i) => (i / 15 - 1) * reach).sort((one, other) => Math.abs(one) - Math.abs(other));
    const enough = alike * near(all, line).length;
    return shifts.map((shift) => [shift - (line[1] * length) / 2, line[1]]).find((side) => near(all, side).length >= enough) ?? line;
  }
  function square(all, line) {
    const own = near(all, line);
    const [along, left] = [0, 1].map((k) => own.reduce((sum, each) => sum + each[k], 0) / own.length);
    const [over, under] = own.reduce(([xy, xx], [x, y]) => [xy + (x - along) * (y - left), xx + (x - along) ** 2], [0, 0]);
    return [left - (over / under) * along, over / under];
  }
  const settled = (all, line) => [1, 2, 3, 4, 5].reduce((each) => square(all, each), line);
  // ends of a line on the returns along it, how many they are and how far it moved; null where it stays
  function fit(line, xyz, heights = [-Infinity, Infinity]) {
    const length = Math.hypot(...minus(line[1], line[0]));
    const all = beside(line, xyz, heights);
    const [off, rise] = settled(all, choose(all, length, settled(all, search(all, length))));
    const own = near(all, [off, rise]);
    const cells = new Set(own.map(([along]) => Math.floor(along / cell)));
    const offs = [off, off + rise * length];
    const moved = Math.max(...offs.map(Math.abs));
    if (!(moved <= reach && Math.abs(rise) <= steep) || own.length < least || cells.size * cell < covered * length) return null;
    const [ux, uy] = unit(line);
    return { line: line.map((end, i) => plus(end, [-uy, ux], offs[i])), n: own.length, moved };
  }

  // an end on another wall stays on its line; what goes on along another wall stays where it is
  function slide([a, b], line, hosts) {
    const way = minus(b, a);
    return [a, b].map((end, i) => {
      if (!hosts[i]) return end;
      const along = minus(hosts[i][1], hosts[i][0]);
      return plus(line[i], along, cross(minus(a, line[i]), way) / cross(along, way));
    });
  }

  let points = null;
  const read = () => (points ??= solid.points().catch(() => [])); // a browser may not unpack them
  // where a line goes and what is said of it, or null
  async function settle(line) {
    const across = (wall) => Math.abs(cross(unit(wall), unit(line)));
    const hosts = line.map((end) => tools.walls().filter((wall) => edits.distance(end, wall) < touching).sort((one, other) => across(other) - across(one))[0]);
    if (hosts.some((wall) => wall && across(wall) < crossing)) return null;
    const found = fit(line, await read(), seen.isPlanar ? undefined : [skirting, solid.height_m - skirting]);
    if (!found) return null;
    const ends = slide(found.line, line, hosts).map((end) => end.map((m) => Number(m.toFixed(3))));
    return { line: ends, said: `On ${found.n} returns, moved by ${Math.round(100 * found.moved)} cm` };
  }
  return { fit, settle, read };
})();

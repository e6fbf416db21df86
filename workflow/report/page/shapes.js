// shapes of rooms, as lists of rings with what is inside on their left: parted by lines, moved along a side, and what lies between two
const shapes = (() => {
  const onSide = 0.05; // metres from a side of a wall to an outline along it, as when corrections are carried out
  const atEnds = 0.3; // metres beyond the ends of a wall that its side still reaches
  const hair = 1e-7; // metres: rounding
  const rounded = 0.002; // metres that places of the page are off by, at most
  const passable = 0.3; // metres: less of a way between rooms is a corner
  const slack = 0.01; // metres that a line is a piece of a room by
  const parallel = Math.cos((2 * Math.PI) / 180); // of sides that face each other
  const cross = (a, b) => a[0] * b[1] - a[1] * b[0];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1];
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];
  const plus = (a, b, t = 1) => [a[0] + t * b[0], a[1] + t * b[1]];
  const next = (ring, i) => ring[(i + 1) % ring.length];
  const unit = ([a, b]) => {
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    return [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
  };
  const sum = (ring) => ring.reduce((total, place, i) => total + cross(place, next(ring, i)), 0) / 2;
  const areaOf = (rings) => rings.reduce((total, ring) => total + sum(ring), 0);
  const edgesOf = (rings) => rings.flatMap((ring) => ring.map((place, i) => [place, next(ring, i)]));

  // of the data of a path: the largest ring is the outer one
  function read(d) {
    const rings = d.split("Z").filter(Boolean).map((text) => text.slice(1).split("L").map((place) => place.split(" ").map(Number)).map(([x, y]) => [x, -y]));
    rings.sort((a, b) => Math.abs(sum(b)) - Math.abs(sum(a)));
    return rings.map((ring, i) => (sum(ring) > 0 === (i === 0) ? ring : ring.toReversed()));
  }
  // whether some places may be within reach of a shape
  const boxes = new WeakMap();
  function isBy(rings, places, by) {
    if (!boxes.has(rings)) boxes.set(rings, [0, 1].map((axis) => rings[0].reduce(([low, high], place) => [Math.min(low, place[axis]), Math.max(high, place[axis])], [Infinity, -Infinity])));
    return boxes.get(rings).every(([low, high], axis) => places.some((place) => place[axis] >= low - by) && places.some((place) => place[axis] <= high + by));
  }
  function has(rings, [x, y]) {
    if (!isBy(rings, [[x, y]], 0)) return false;
    let isIn = false;
    for (const [[ax, ay], [bx, by]] of edgesOf(rings)) if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) isIn = !isIn;
    return isIn;
  }
  function distance(rings, at) {
    return has(rings, at) ? 0 : edgesOf(rings).reduce((least, edge) => Math.min(least, edits.distance(at, edge)), Infinity);
  }
  // somewhere inside: the middle of the widest stretch half way up
  function within(rings) {
    const ys = rings[0].map(([, y]) => y).sort((a, b) => a - b);
    const y = (ys[0] + ys.at(-1)) / 2 + hair;
    const xs = edgesOf(rings).filter(([a, b]) => a[1] > y !== b[1] > y).map(([a, b]) => a[0] + ((y - a[1]) / (b[1] - a[1])) * (b[0] - a[0])).sort((a, b) => a - b);
    let best = 0;
    for (let i = 0; i < xs.length; i += 2) if (xs[i + 1] - xs[i] > xs[best + 1] - xs[best]) best = i;
    return [(xs[best] + xs[best + 1]) / 2, y];
  }

  // --- parted by lines ---
  // pieces of a line, made longer, that lie inside: from metre to metre along it
  function pieces(rings, line, over = 0) {
    if (!isBy(rings, line, over)) return [];
    const u = unit(line);
    const length = dot(minus(line[1], line[0]), u);
    const at = [-over, length + over];
    for (const [a, b] of edgesOf(rings)) {
      const [offA, offB] = [a, b].map((place) => cross(u, minus(place, line[0])));
      if (offA > 0 === offB > 0) continue;
      at.push(dot(minus(plus(a, minus(b, a), offA / (offA - offB)), line[0]), u));
    }
    const found = [];
    at.sort((a, b) => a - b);
    for (let i = 0; i + 1 < at.length; i++) {
      const [from, to] = [Math.max(at[i], -over), Math.min(at[i + 1], length + over)];
      if (to - from < hair || !has(rings, plus(line[0], u, (from + to) / 2))) continue;
      if (to > slack && from < length - slack) found.push({ from, to, ends: [from, to].map((m) => plus(line[0], u, m)) });
    }
    return found;
  }
  const lengthIn = (rings, line) => pieces(rings, line).reduce((total, { from, to }) => total + to - from, 0);
  function locate(loops, at) {
    return loops.flatMap((loop, l) => loop.flatMap((a, i) => (edits.distance(at, [a, next(loop, i)]) < 1e-6 ? [[l, i]] : [])));
  }
  const doCross = ([a, b], [c, d]) => {
    const side = (p, q, r) => cross(minus(q, p), minus(r, p));
    // what only touches does not
    const apart = (one, other) => Math.min(one, other) < -hair && Math.max(one, other) > hair;
    return apart(side(a, b, c), side(a, b, d)) && apart(side(c, d, a), side(c, d, b));
  };
  // parts by pieces from outline to outline that do not cross, or null
  function part(rings, chords) {
    if (chords.some((one, i) => chords.slice(i + 1).some((other) => doCross(one, other)))) return null;
    let loops = rings;
    for (const [a, b] of chords) {
      const [atA, atB] = [locate(loops, a), locate(loops, b)];
      const both = atA.flatMap((one) => atB.map((other) => [one, other]));
      const [[l, i], [m, j]] = both.find(([one, other]) => one[0] === other[0] && one[1] !== other[1]) ?? both[0] ?? [[-1, 0], [-1, 0]];
      if (l < 0) return null;
      const turn = (loop, after) => [...loop.slice(after + 1), ...loop.slice(0, after + 1)];
      if (l === m) {
        const loop = turn(loops[l], i); // from behind a, round to before it
        const to = (j - i - 1 + loop.length) % loop.length;
        loops = [...loops.filter((_, k) => k !== l), [a, ...loop.slice(0, to + 1), b], [b, ...loop.slice(to + 1), a]];
      } else {
        loops = [...loops.filter((_, k) => k !== l && k !== m), [a, ...turn(loops[l], i), a, b, ...turn(loops[m], j), b]];
      }
    }
    const outer = loops.filter((loop) => sum(loop) > hair).sort((a, b) => sum(a) - sum(b)).map((loop) => [loop]);
    for (const loop of loops.filter((each) => sum(each) < -hair)) outer.find(([around]) => has([around], loop[0]))?.push(loop);
    return outer.sort((a, b) => areaOf(b) - areaOf(a));
  }

  // --- moved with a side of a wall, which has its room on its left; null where rounding decides ---
  function follow(rings, old, to) {
    const [u, v] = [unit(old), unit(to)];
    const n = [-u[1], u[0]];
    const m = [-v[1], v[0]];
    if (dot(u, v) < 0.5 || !isBy(rings, old, atEnds)) return rings;
    const length = dot(minus(old[1], old[0]), u);
    const shift = (place) => {
      const foot = plus(place, n, -dot(minus(place, old[0]), n));
      return plus(place, n, -dot(minus(foot, to[0]), m) / dot(n, m));
    };
    let isSure = true;
    const isMore = (value, limit) => {
      if (Math.abs(value - limit) < rounded) isSure = false;
      return value > limit;
    };
    const moved = rings.map((ring) => {
      const along = ring.map((place) => dot(minus(place, old[0]), u));
      const off = ring.map((place) => Math.abs(dot(minus(place, old[0]), n)));
      const isIn = along.map((s, i) => off[i] <= onSide + rounded && !isMore(-s, atEnds) && !isMore(s - length, atEnds));
      // what begins where the side ends is along another wall
      const isAlong = ring.map((_, i) => {
        const [from, to] = [along[i], next(along, i)];
        const over = Math.min(to, length) - Math.max(from, 0);
        // what is not even beside it decides nothing
        if (to <= from || over < -rounded) return false;
        if (to - from < 5 * rounded) return Math.max(off[i], next(off, i)) <= onSide && over > 0; // nor does what is that short
        return !isMore(Math.max(off[i], next(off, i)), onSide) && isMore(over, Math.min((to - from) / 2, onSide));
      });
      return ring.flatMap((place, i) => {
        const made = [isIn[i] && (isAlong[i] || isAlong.at(i - 1)) ? shift(place) : place];
        const [from, to] = [along[i], next(along, i)];
        const at = (s) => plus(place, minus(next(ring, i), place), (s - from) / (to - from));
        if (isAlong[i] && from < -atEnds) made.push(at(0), shift(at(0)));
        if (isAlong[i] && to > length + atEnds) made.push(shift(at(length)), at(length));
        return made;
      });
    });
    const stays = new Set(rings.flat());
    if (moved.every((ring) => ring.every((place) => stays.has(place)))) return rings;
    if (!isSure) return null;
    const edges = edgesOf(moved);
    const shifted = edges.filter(([a, b]) => !stays.has(a) || !stays.has(b));
    const isWhole = moved.every((ring, i) => sum(ring) > 0 === sum(rings[i]) > 0) && !shifted.some((one) => edges.some((other) => doCross(one, other)));
    return isWhole ? moved : rings;
  }

  // --- between two: strips from side to side, less what stands in them; null where that is not simple ---
  function gapOf(one, two) {
    const others = edgesOf(two);
    let least = Infinity;
    for (const e of edgesOf(one)) {
      for (const f of others) least = Math.min(least, edits.distance(f[0], e), edits.distance(e[0], f));
    }
    return least;
  }
  function between(one, two, walls, openings) {
    const gap = gapOf(one, two);
    if (gap < 1e-3) return 0;
    let [total, open] = [0, 0];
    for (const e of edgesOf(one)) {
      const [u, length] = [unit(e), Math.hypot(...minus(e[1], e[0]))];
      const lay = (at) => [dot(minus(at, e[0]), u), -cross(u, minus(at, e[0]))]; // along, and out of the room
      for (const f of edgesOf(two)) {
        if (dot(unit(f), u) > -parallel) continue;
        const [[fromX, fromY], [toX, toY]] = [lay(f[1]), lay(f[0])];
        const slope = (toY - fromY) / (toX - fromX);
        const up = (x) => fromY + slope * (x - fromX);
        const [x0, x1] = [Math.max(0, fromX), Math.min(length, toX)];
        const [nearest, farthest] = [up(x0), up(x1)].sort((a, b) => a - b);
        const widest = gap + 2 * slack; // is bridged
        if (x1 - x0 < hair || nearest <= hair || nearest > widest) continue;
        // wedges are bridged in part
        if (farthest > widest) return null;
        const boxes = stand(walls, openings, lay, [x0, x1], widest);
        if (!boxes) return null;
        const cuts = [...new Set([x0, x1, ...boxes.flatMap(({ x }) => x)])].filter((x) => x >= x0 && x <= x1).sort((a, b) => a - b);
        for (let i = 0; i + 1 < cuts.length; i++) {
          const middle = (cuts[i] + cuts[i + 1]) / 2;
          let [free, top] = [0, 0];
          for (const { y } of boxes.filter(({ x }) => x[0] < middle && x[1] > middle).sort((a, b) => a.y[0] - b.y[0])) {
            free += Math.max(0, Math.min(y[0], up(middle)) - top);
            top = Math.max(top, Math.min(y[1], up(middle)));
          }
          if (top === 0) open += cuts[i + 1] - cuts[i];
          total += (free + up(middle) - top) * (cuts[i + 1] - cuts[i]);
        }
      }
    }
    return open >= passable ? total : null;
  }
  // what of walls stands in a strip: from where to where along it and across; what is neither along nor across is not simple
  function stand(walls, openings, lay, [x0, x1], depth) {
    const ordered = (a, b) => [Math.min(a, b), Math.max(a, b)];
    const gaps = openings.map((line) => line.map(lay)).filter(([a, b]) => Math.abs(b[1] - a[1]) < 0.1 * Math.abs(b[0] - a[0]));
    const found = [];
    for (const { line, half, isCurved } of walls) {
      const [a, b] = line.map(lay);
      const [x, y] = [0, 1].map((axis) => ordered(a[axis], b[axis]));
      const box = { x: [x[0] - half, x[1] + half], y: [y[0] - half, y[1] + half] };
      if (box.x[1] <= x0 || box.x[0] >= x1 || box.y[1] <= 0 || box.y[0] >= depth) continue;
      const isAlong = y[1] - y[0] < 0.1 * (x[1] - x[0]);
      if (isCurved || !(isAlong || x[1] - x[0] < 0.1 * (y[1] - y[0]))) return null;
      if (isAlong) box.y = [(y[0] + y[1]) / 2 - half, (y[0] + y[1]) / 2 + half];
      else box.x = [(x[0] + x[1]) / 2 - half, (x[0] + x[1]) / 2 + half];
      let left = [box.x];
      for (const [c, d] of gaps) {
        if (Math.abs((c[1] + d[1]) / 2 - (box.y[0] + box.y[1]) / 2) > 1) continue; // metres that an opening is cut through
        const [from, to] = ordered(c[0], d[0]);
        left = left.flatMap(([low, high]) => [[low, Math.min(high, from)], [Math.max(low, to), high]].filter(([start, end]) => end - start > hair));
      }
      found.push(...left.map((each) => ({ x: each, y: box.y })));
    }
    return found;
  }
  return { cross, minus, plus, unit, read, has, distance, within, areaOf, pieces, lengthIn, part, follow, gapOf, between };
})();

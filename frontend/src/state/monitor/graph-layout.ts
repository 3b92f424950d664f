import { isotonic } from "./isotonic";

export interface Box {
  id: string;
  width: number;
  height: number;
}

export interface Link {
  from: string;
  to: string;
}

/** A box with the position of its center. */
export interface PlacedBox extends Box {
  x: number;
  y: number;
}

/** The path of a link from the edge of one box to that of the other, around the boxes in between. */
export interface Route extends Link {
  points: [number, number][];
}

export interface Layout {
  boxes: Map<string, PlacedBox>;
  routes: Route[];
  width: number;
  height: number;
}

const LAYER_GAP = 56;
const BOX_GAP = 14;
const DUMMY_HEIGHT = 6;
const ORDER_SWEEPS = 12;
const PLACE_SWEEPS = 10;
/** Half the distance between the two links of boxes that are linked in both directions. */
const PAIR_OFFSET = 4;

/** A box, or a dummy where a long link passes a layer. */
interface Vertex {
  box: Box | null;
  layer: number;
  x: number;
  y: number;
  height: number;
  before: Vertex[];
  after: Vertex[];
}

/**
 * Places boxes in layers from left to right, so that links point to the right where possible, rarely cross and are
 * short.
 *
 * This is Sugiyama's method: links that would close a cycle are reversed temporarily, each box is placed behind those
 * that link to it, long links get a dummy in each layer that they pass, layers are ordered by the mean position of the
 * neighbors, and vertical positions are as close to those of the neighbors as the order permits. Boxes without links
 * are placed in rows below.
 */
export function layOutLayers(boxes: readonly Box[], links: readonly Link[]): Layout {
  const known = new Map(boxes.map((box) => [box.id, box]));
  const proper = links.filter(({ from, to }) => from !== to && known.has(from) && known.has(to));
  const linked = new Set(proper.flatMap(({ from, to }) => [from, to]));
  const turned = cycleClosingLinks(boxes, proper);
  const forward = proper.map((link) => (turned.has(link) ? { from: link.to, to: link.from } : link));
  const layerOf = layersOf(boxes.filter(({ id }) => linked.has(id)), forward);
  const vertices = new Map<string, Vertex>();
  const layers: Vertex[][] = [];
  const add = (box: Box | null, layer: number): Vertex => {
    const vertex = { box, layer, x: 0, y: 0, height: box?.height ?? DUMMY_HEIGHT, before: [], after: [] };
    (layers[layer] ??= []).push(vertex);
    if (box) vertices.set(box.id, vertex);
    return vertex;
  };
  for (const box of boxes) if (linked.has(box.id)) add(box, layerOf.get(box.id) ?? 0);
  const chains = forward.map(({ from, to }) => connectLayers(vertices, from, to, add));
  orderLayers(layers);
  placeVertically(layers);
  const width = placeLayers(layers);
  const result: Layout = { boxes: new Map(), routes: [], width, height: 0 };
  for (const [id, { box, x, y }] of vertices) if (box) result.boxes.set(id, { ...box, id, x, y });
  const pairs = new Set(proper.map(({ from, to }) => `${from}\n${to}`));
  proper.forEach((link, index) => {
    const offset = pairs.has(`${link.to}\n${link.from}`) ? (turned.has(link) ? PAIR_OFFSET : -PAIR_OFFSET) : 0;
    const points = route(chains[index] ?? [], offset);
    result.routes.push({ from: link.from, to: link.to, points: turned.has(link) ? points.reverse() : points });
  });
  shiftToOrigin(result);
  placeUnlinked(boxes.filter(({ id }) => !linked.has(id)), result);
  return result;
}

/** Returns the links that close a cycle, by a depth-first search. */
function cycleClosingLinks(boxes: readonly Box[], links: readonly Link[]): Set<Link> {
  const outgoing = new Map<string, Link[]>();
  const incoming = new Set(links.map(({ to }) => to));
  for (const link of links) outgoing.set(link.from, [...(outgoing.get(link.from) ?? []), link]);
  const closers = new Set<Link>();
  const state = new Map<string, "open" | "done">();
  const visit = (start: string): void => {
    const path = [{ id: start, next: 0 }];
    state.set(start, "open");
    for (let top = path.at(-1); top; top = path.at(-1)) {
      const link = outgoing.get(top.id)?.[top.next++];
      if (!link) {
        state.set(top.id, "done");
        path.pop();
      } else if (state.get(link.to) === "open") closers.add(link);
      else if (!state.has(link.to)) {
        state.set(link.to, "open");
        path.push({ id: link.to, next: 0 });
      }
    }
  };
  // Start at boxes without incoming links, where paths begin.
  const starts = [...boxes].sort((a, b) => Number(incoming.has(a.id)) - Number(incoming.has(b.id)));
  for (const { id } of starts) if (!state.has(id)) visit(id);
  return closers;
}

/** Returns the layer of each box: behind all boxes that link to it, and as close to its targets as that permits. */
function layersOf(boxes: readonly Box[], links: readonly Link[]): Map<string, number> {
  const layer = new Map(boxes.map(({ id }) => [id, 0]));
  const at = (id: string): number => layer.get(id) ?? 0;
  for (let round = 0, moved = true; moved && round <= boxes.length; round++) {
    moved = false;
    for (const { from, to } of links) {
      if (at(to) > at(from)) continue;
      layer.set(to, at(from) + 1);
      moved = true;
    }
  }
  const pointedAt = new Set(links.map(({ to }) => to));
  for (const { id } of boxes) {
    if (pointedAt.has(id)) continue;
    const targets = links.filter(({ from }) => from === id).map(({ to }) => at(to));
    layer.set(id, Math.min(...targets) - 1);
  }
  return layer;
}

function connectLayers(
  vertices: ReadonlyMap<string, Vertex>,
  from: string,
  to: string,
  add: (box: null, layer: number) => Vertex,
): Vertex[] {
  const [start, end] = [vertices.get(from), vertices.get(to)];
  if (!start || !end) return [];
  const way = [start];
  for (let layer = start.layer + 1; layer < end.layer; layer++) way.push(add(null, layer));
  way.push(end);
  for (let index = 1; index < way.length; index++) {
    const [left, right] = [way[index - 1], way[index]];
    if (!left || !right) continue;
    left.after.push(right);
    right.before.push(left);
  }
  return way;
}

/**
 * Orders each layer by the mean position of the neighbors, in both directions, and keeps the order with the fewest
 * crossings.
 */
function orderLayers(layers: Vertex[][]): void {
  let best = layers.map((layer) => [...layer]);
  let fewest = crossings(layers);
  for (let sweep = 0; sweep < ORDER_SWEEPS && fewest > 0; sweep++) {
    const forth = sweep % 2 === 0;
    const places = new Map<Vertex, number>();
    const number = (layer: Vertex[]): void => layer.forEach((vertex, at) => places.set(vertex, at));
    layers.forEach(number);
    for (const layer of forth ? layers : [...layers].reverse()) {
      const middles = new Map(
        layer.map((vertex) => {
          const near = forth ? vertex.before : vertex.after;
          const sum = near.reduce((total, each) => total + (places.get(each) ?? 0), 0);
          return [vertex, near.length > 0 ? sum / near.length : (places.get(vertex) ?? 0)];
        }),
      );
      layer.sort((a, b) => (middles.get(a) ?? 0) - (middles.get(b) ?? 0));
      number(layer);
    }
    const count = crossings(layers);
    if (count < fewest) {
      fewest = count;
      best = layers.map((layer) => [...layer]);
    }
  }
  best.forEach((layer, index) => (layers[index] = layer));
}

function crossings(layers: readonly (readonly Vertex[])[]): number {
  let count = 0;
  for (let index = 1; index < layers.length; index++) {
    const places = new Map(layers[index]?.map((vertex, at) => [vertex, at]));
    const ends = (layers[index - 1] ?? []).map((vertex) => vertex.after.map((each) => places.get(each) ?? 0));
    const seen: number[] = [];
    for (const group of ends) {
      for (const end of group) count += seen.filter((other) => other > end).length;
      seen.push(...group);
    }
  }
  return count;
}

/** Computes vertical positions, each as close to the mean of its neighbors as the order and the gaps permit. */
function placeVertically(layers: readonly (readonly Vertex[])[]): void {
  for (const layer of layers) {
    let y = 0;
    for (const vertex of layer) {
      vertex.y = y + vertex.height / 2;
      y += vertex.height + BOX_GAP;
    }
  }
  for (let sweep = 0; sweep < PLACE_SWEEPS; sweep++) {
    const forth = sweep % 2 === 0;
    for (const layer of forth ? layers : [...layers].reverse()) {
      const wanted = layer.map((vertex) => {
        const near = sweep >= PLACE_SWEEPS - 2 ? [...vertex.before, ...vertex.after] : forth ? vertex.before : vertex.after;
        return near.length > 0 ? near.reduce((sum, each) => sum + each.y, 0) / near.length : vertex.y;
      });
      const offsets: number[] = [];
      layer.forEach((vertex, index) => {
        const above = layer[index - 1];
        offsets.push(above ? (offsets[index - 1] ?? 0) + (above.height + vertex.height) / 2 + BOX_GAP : 0);
      });
      const free = isotonic(wanted.map((y, index) => y - (offsets[index] ?? 0)));
      layer.forEach((vertex, index) => (vertex.y = (free[index] ?? 0) + (offsets[index] ?? 0)));
    }
  }
}

/** Sets the horizontal position of each layer, and returns the total width. */
function placeLayers(layers: readonly (readonly Vertex[])[]): number {
  let x = 0;
  for (const layer of layers) {
    const width = Math.max(0, ...layer.map((vertex) => vertex.box?.width ?? 0));
    for (const vertex of layer) vertex.x = x + width / 2;
    x += width + LAYER_GAP;
  }
  return Math.max(0, x - LAYER_GAP);
}

function route(way: readonly Vertex[], offset: number): [number, number][] {
  return way.map(({ box, x, y }, index) => {
    const half = (box?.width ?? 0) / 2;
    return [index === 0 ? x + half : index === way.length - 1 ? x - half : x, y + offset];
  });
}

function shiftToOrigin(layout: Layout): void {
  const boxes = [...layout.boxes.values()];
  if (boxes.length === 0) return;
  const points = layout.routes.flatMap((each) => each.points);
  const top = Math.min(...boxes.map(({ y, height }) => y - height / 2), ...points.map(([, y]) => y));
  for (const box of boxes) box.y -= top;
  for (const point of points) point[1] -= top;
  layout.height = Math.max(...boxes.map(({ y, height }) => y + height / 2), ...points.map(([, y]) => y));
}

/** Places boxes without links in rows below the others. */
function placeUnlinked(boxes: readonly Box[], layout: Layout): void {
  const most = Math.max(layout.width, 640);
  let [x, y, rowHeight] = [0, layout.height > 0 ? layout.height + 2 * BOX_GAP : 0, 0];
  for (const box of boxes) {
    if (x > 0 && x + box.width > most) [x, y, rowHeight] = [0, y + rowHeight + BOX_GAP, 0];
    layout.boxes.set(box.id, { ...box, x: x + box.width / 2, y: y + box.height / 2 });
    layout.width = Math.max(layout.width, x + box.width);
    layout.height = Math.max(layout.height, y + box.height);
    x += box.width + BOX_GAP;
    rowHeight = Math.max(rowHeight, box.height);
  }
}

import { fitIsotonic } from "./isotonic";

export interface Box {
  id: string;
  width: number;
  height: number;
}

export interface Link {
  source: string;
  target: string;
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

const LAYER_GAP_PX = 56;
const BOX_GAP_PX = 14;
const DUMMY_HEIGHT_PX = 6;
const ORDER_SWEEP_COUNT = 12;
const PLACE_SWEEP_COUNT = 10;
/** Half the distance between the two links of boxes that are linked in both directions. */
const PAIR_OFFSET_PX = 4;

/** A box, or a dummy where a long link passes a layer. */
interface Vertex {
  box: Box | null;
  layer: number;
  x: number;
  y: number;
  height: number;
  predecessors: Vertex[];
  successors: Vertex[];
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
  const boxIds = new Map(boxes.map((box) => [box.id, box]));
  const validLinks = links.filter(({ source, target }) => source !== target && boxIds.has(source) && boxIds.has(target));
  const linkedBoxes = new Set(validLinks.flatMap(({ source, target }) => [source, target]));
  const reversedLinks = findCycleClosingLinks(boxes, validLinks);
  const forwardLinks = validLinks.map((link) => (reversedLinks.has(link) ? { source: link.target, target: link.source } : link));
  const layerOf = assignLayers(boxes.filter(({ id }) => linkedBoxes.has(id)), forwardLinks);
  const vertices = new Map<string, Vertex>();
  const layers: Vertex[][] = [];
  const addVertex = (box: Box | null, layer: number): Vertex => {
    const vertex = { box, layer, x: 0, y: 0, height: box?.height ?? DUMMY_HEIGHT_PX, predecessors: [], successors: [] };
    (layers[layer] ??= []).push(vertex);
    if (box) vertices.set(box.id, vertex);
    return vertex;
  };
  for (const box of boxes) if (linkedBoxes.has(box.id)) addVertex(box, layerOf.get(box.id) ?? 0);
  const chains = forwardLinks.map(({ source, target }) => connectLayers(vertices, source, target, addVertex));
  orderLayers(layers);
  placeVertically(layers);
  const width = placeHorizontally(layers);
  const result: Layout = { boxes: new Map(), routes: [], width, height: 0 };
  for (const [id, { box, x, y }] of vertices) if (box) result.boxes.set(id, { ...box, id, x, y });
  const pairs = new Set(validLinks.map(({ source, target }) => `${source}\n${target}`));
  validLinks.forEach((link, index) => {
    const offset = pairs.has(`${link.target}\n${link.source}`) ? (reversedLinks.has(link) ? PAIR_OFFSET_PX : -PAIR_OFFSET_PX) : 0;
    const points = routeThrough(chains[index] ?? [], offset);
    result.routes.push({ source: link.source, target: link.target, points: reversedLinks.has(link) ? points.reverse() : points });
  });
  shiftToOrigin(result);
  placeUnlinkedBoxes(boxes.filter(({ id }) => !linkedBoxes.has(id)), result);
  return result;
}

/** Returns the links that close a cycle, by a depth-first search. */
function findCycleClosingLinks(boxes: readonly Box[], links: readonly Link[]): Set<Link> {
  const outgoing = new Map<string, Link[]>();
  const incoming = new Set(links.map(({ target }) => target));
  for (const link of links) outgoing.set(link.source, [...(outgoing.get(link.source) ?? []), link]);
  const closingLinks = new Set<Link>();
  const state = new Map<string, "open" | "done">();
  const searchFrom = (start: string): void => {
    const path = [{ id: start, next: 0 }];
    state.set(start, "open");
    for (let top = path.at(-1); top; top = path.at(-1)) {
      const link = outgoing.get(top.id)?.[top.next++];
      if (!link) {
        state.set(top.id, "done");
        path.pop();
      } else if (state.get(link.target) === "open") closingLinks.add(link);
      else if (!state.has(link.target)) {
        state.set(link.target, "open");
        path.push({ id: link.target, next: 0 });
      }
    }
  };
  // Start at boxes without incoming links, where paths begin.
  const startBoxes = [...boxes].sort((a, b) => Number(incoming.has(a.id)) - Number(incoming.has(b.id)));
  for (const { id } of startBoxes) if (!state.has(id)) searchFrom(id);
  return closingLinks;
}

/** Returns the layer of each box: behind all boxes that link to it, and as close to its targets as that permits. */
function assignLayers(boxes: readonly Box[], links: readonly Link[]): Map<string, number> {
  const layer = new Map(boxes.map(({ id }) => [id, 0]));
  const layerOf = (id: string): number => layer.get(id) ?? 0;
  for (let round = 0, hasMoved = true; hasMoved && round <= boxes.length; round++) {
    hasMoved = false;
    for (const { source, target } of links) {
      if (layerOf(target) > layerOf(source)) continue;
      layer.set(target, layerOf(source) + 1);
      hasMoved = true;
    }
  }
  const targetIds = new Set(links.map(({ target }) => target));
  for (const { id } of boxes) {
    if (targetIds.has(id)) continue;
    const targets = links.filter(({ source }) => source === id).map(({ target }) => layerOf(target));
    layer.set(id, Math.min(...targets) - 1);
  }
  return layer;
}

function connectLayers(
  vertices: ReadonlyMap<string, Vertex>,
  source: string,
  target: string,
  addVertex: (box: null, layer: number) => Vertex,
): Vertex[] {
  const [start, end] = [vertices.get(source), vertices.get(target)];
  if (!start || !end) return [];
  const chain = [start];
  for (let layer = start.layer + 1; layer < end.layer; layer++) chain.push(addVertex(null, layer));
  chain.push(end);
  for (let index = 1; index < chain.length; index++) {
    const [left, right] = [chain[index - 1], chain[index]];
    if (!left || !right) continue;
    left.successors.push(right);
    right.predecessors.push(left);
  }
  return chain;
}

/**
 * Orders each layer by the mean position of the neighbors, in both directions, and keeps the order with the fewest
 * crossings.
 */
function orderLayers(layers: Vertex[][]): void {
  let bestLayers = layers.map((layer) => [...layer]);
  let fewestCrossings = countCrossings(layers);
  for (let sweep = 0; sweep < ORDER_SWEEP_COUNT && fewestCrossings > 0; sweep++) {
    const isForward = sweep % 2 === 0;
    const indexes = new Map<Vertex, number>();
    const recordIndexes = (layer: Vertex[]): void => layer.forEach((vertex, index) => indexes.set(vertex, index));
    layers.forEach(recordIndexes);
    for (const layer of isForward ? layers : [...layers].reverse()) {
      const meanIndexes = new Map(
        layer.map((vertex) => {
          const neighbors = isForward ? vertex.predecessors : vertex.successors;
          const sum = neighbors.reduce((total, neighbor) => total + (indexes.get(neighbor) ?? 0), 0);
          return [vertex, neighbors.length > 0 ? sum / neighbors.length : (indexes.get(vertex) ?? 0)];
        }),
      );
      layer.sort((a, b) => (meanIndexes.get(a) ?? 0) - (meanIndexes.get(b) ?? 0));
      recordIndexes(layer);
    }
    const count = countCrossings(layers);
    if (count < fewestCrossings) {
      fewestCrossings = count;
      bestLayers = layers.map((layer) => [...layer]);
    }
  }
  bestLayers.forEach((layer, index) => (layers[index] = layer));
}

function countCrossings(layers: readonly (readonly Vertex[])[]): number {
  let count = 0;
  for (let index = 1; index < layers.length; index++) {
    const indexes = new Map(layers[index]?.map((vertex, index) => [vertex, index]));
    const targetIndexes = (layers[index - 1] ?? []).map((vertex) => vertex.successors.map((neighbor) => indexes.get(neighbor) ?? 0));
    const previousIndexes: number[] = [];
    for (const indexesOfVertex of targetIndexes) {
      for (const targetIndex of indexesOfVertex) count += previousIndexes.filter((previousIndex) => previousIndex > targetIndex).length;
      previousIndexes.push(...indexesOfVertex);
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
      y += vertex.height + BOX_GAP_PX;
    }
  }
  for (let sweep = 0; sweep < PLACE_SWEEP_COUNT; sweep++) {
    const isForward = sweep % 2 === 0;
    for (const layer of isForward ? layers : [...layers].reverse()) {
      const idealYs = layer.map((vertex) => {
        const neighbors = sweep >= PLACE_SWEEP_COUNT - 2 ? [...vertex.predecessors, ...vertex.successors] : isForward ? vertex.predecessors : vertex.successors;
        return neighbors.length > 0 ? neighbors.reduce((sum, neighbor) => sum + neighbor.y, 0) / neighbors.length : vertex.y;
      });
      const offsets: number[] = [];
      layer.forEach((vertex, index) => {
        const vertexAbove = layer[index - 1];
        offsets.push(vertexAbove ? (offsets[index - 1] ?? 0) + (vertexAbove.height + vertex.height) / 2 + BOX_GAP_PX : 0);
      });
      const fittedYs = fitIsotonic(idealYs.map((y, index) => y - (offsets[index] ?? 0)));
      layer.forEach((vertex, index) => (vertex.y = (fittedYs[index] ?? 0) + (offsets[index] ?? 0)));
    }
  }
}

/** Sets the horizontal position of each layer, and returns the total width. */
function placeHorizontally(layers: readonly (readonly Vertex[])[]): number {
  let x = 0;
  for (const layer of layers) {
    const width = Math.max(0, ...layer.map((vertex) => vertex.box?.width ?? 0));
    for (const vertex of layer) vertex.x = x + width / 2;
    x += width + LAYER_GAP_PX;
  }
  return Math.max(0, x - LAYER_GAP_PX);
}

function routeThrough(vertices: readonly Vertex[], offset: number): [number, number][] {
  return vertices.map(({ box, x, y }, index) => {
    const halfWidth = (box?.width ?? 0) / 2;
    return [index === 0 ? x + halfWidth : index === vertices.length - 1 ? x - halfWidth : x, y + offset];
  });
}

function shiftToOrigin(layout: Layout): void {
  const boxes = [...layout.boxes.values()];
  if (boxes.length === 0) return;
  const points = layout.routes.flatMap((route) => route.points);
  const top = Math.min(...boxes.map(({ y, height }) => y - height / 2), ...points.map(([, y]) => y));
  for (const box of boxes) box.y -= top;
  for (const point of points) point[1] -= top;
  layout.height = Math.max(...boxes.map(({ y, height }) => y + height / 2), ...points.map(([, y]) => y));
}

/** Places boxes without links in rows below the others. */
function placeUnlinkedBoxes(boxes: readonly Box[], layout: Layout): void {
  const maxWidth = Math.max(layout.width, 640);
  let [x, y, rowHeight] = [0, layout.height > 0 ? layout.height + 2 * BOX_GAP_PX : 0, 0];
  for (const box of boxes) {
    if (x > 0 && x + box.width > maxWidth) [x, y, rowHeight] = [0, y + rowHeight + BOX_GAP_PX, 0];
    layout.boxes.set(box.id, { ...box, x: x + box.width / 2, y: y + box.height / 2 });
    layout.width = Math.max(layout.width, x + box.width);
    layout.height = Math.max(layout.height, y + box.height);
    x += box.width + BOX_GAP_PX;
    rowHeight = Math.max(rowHeight, box.height);
  }
}

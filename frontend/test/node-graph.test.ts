import { describe, expect, it } from "vitest";
import type { NodeGraph } from "../src/protocol";
import { layOutLayers, type Layout, type Link } from "../src/state/monitor/graph-layout";
import { buildGraph, type GraphOptions } from "../src/state/monitor/graph-model";
import { isotonic } from "../src/state/monitor/isotonic";

const box = (id: string): { id: string; width: number; height: number } => ({ id, width: 100, height: 28 });
const link = (source: string, target: string): Link => ({ source, target });

function overlaps({ boxes }: Layout): string[] {
  const all = [...boxes.values()];
  return all.flatMap((a, index) =>
    all
      .slice(index + 1)
      .filter((b) => Math.abs(a.x - b.x) < (a.width + b.width) / 2 && Math.abs(a.y - b.y) < (a.height + b.height) / 2)
      .map((b) => `${a.id} ${b.id}`),
  );
}

describe("the layout", () => {
  it("goes from left to right", () => {
    const { boxes, routes } = layOutLayers(["a", "b", "c"].map(box), [link("a", "b"), link("b", "c")]);
    const xs = ["a", "b", "c"].map((id) => boxes.get(id)?.x ?? 0);
    expect(xs[0]).toBeLessThan(xs[1] ?? 0);
    expect(xs[1]).toBeLessThan(xs[2] ?? 0);
    const [first, last] = [routes[0]?.points[0], routes[0]?.points.at(-1)];
    expect(first?.[0]).toBe((xs[0] ?? 0) + 50);
    expect(last?.[0]).toBe((xs[1] ?? 0) - 50);
  });

  it("keeps boxes apart and within the drawing", () => {
    const ids = Array.from({ length: 40 }, (_, index) => `n${index}`);
    const links = ids.flatMap((id, index) => [link(id, `n${(index * 7 + 3) % 40}`), link(id, `n${(index * 3 + 11) % 40}`)]);
    const layout = layOutLayers(ids.map(box), links);
    expect(layout.boxes.size).toBe(40);
    expect(overlaps(layout)).toEqual([]);
    for (const { x, y, width, height } of layout.boxes.values()) {
      expect(x - width / 2).toBeGreaterThanOrEqual(-1e-6);
      expect(y - height / 2).toBeGreaterThanOrEqual(-1e-6);
      expect(x + width / 2).toBeLessThanOrEqual(layout.width + 1e-6);
      expect(y + height / 2).toBeLessThanOrEqual(layout.height + 1e-6);
    }
  });

  it("handles cycles, and separates two links between the same boxes", () => {
    const layout = layOutLayers(["a", "b"].map(box), [link("a", "b"), link("b", "a")]);
    const [there, back] = layout.routes;
    expect(there?.points[0]?.[1]).not.toBe(back?.points[0]?.[1]);
    expect(back?.points[0]?.[0]).toBeGreaterThan(back?.points.at(-1)?.[0] ?? 0);
  });

  it("removes avoidable crossings", () => {
    const layout = layOutLayers(["a", "b", "x", "y"].map(box), [link("a", "y"), link("b", "x")]);
    const y = (id: string): number => layout.boxes.get(id)?.y ?? 0;
    expect(Math.sign(y("a") - y("b"))).toBe(Math.sign(y("y") - y("x")));
  });

  it("routes long links around the boxes between their ends", () => {
    const layout = layOutLayers(["a", "b", "c"].map(box), [link("a", "b"), link("b", "c"), link("a", "c")]);
    const way = layout.routes.find(({ source, target }) => source === "a" && target === "c");
    expect(way?.points).toHaveLength(3);
    const middle = layout.boxes.get("b");
    expect(Math.abs((way?.points[1]?.[1] ?? 0) - (middle?.y ?? 0))).toBeGreaterThan(14);
  });

  it("puts boxes without links below, in rows", () => {
    const ids = ["a", "b", ...Array.from({ length: 12 }, (_, index) => `alone${index}`)];
    const layout = layOutLayers(ids.map(box), [link("a", "b")]);
    expect(overlaps(layout)).toEqual([]);
    const below = ids.slice(2).map((id) => layout.boxes.get(id)?.y ?? 0);
    expect(Math.min(...below)).toBeGreaterThan(layout.boxes.get("a")?.y ?? 0);
    expect(new Set(below).size).toBeGreaterThan(1);
  });

  it("of an empty graph is empty", () => {
    expect(layOutLayers([], [])).toMatchObject({ width: 0, height: 0 });
  });

  it("is fast for hundreds of nodes", () => {
    const ids = Array.from({ length: 300 }, (_, index) => `n${index}`);
    const links = ids.slice(1).map((id, index) => link(`n${Math.floor(index / 3)}`, id));
    const started = performance.now();
    layOutLayers(ids.map(box), links);
    expect(performance.now() - started).toBeLessThan(1000);
  });
});

describe("averaging unordered neighbors", () => {
  it("does not change ordered values", () => expect(isotonic([1, 2, 2, 5])).toEqual([1, 2, 2, 5]));
  it("averages values out of order", () => expect(isotonic([3, 1, 2, 10])).toEqual([2, 2, 2, 10]));
});

const GRAPH: NodeGraph = {
  type: "node_graph",
  nodes: ["/base", "/left/arm", "/left/hand", "/talker"],
  topics: [
    { name: "/chatter", types: ["t"], publishers: ["/talker"], subscribers: ["/base"] },
    { name: "/echo", types: ["t"], publishers: ["/talker"], subscribers: [] },
    { name: "/left/grip", types: ["t"], publishers: ["/left/arm"], subscribers: ["/left/hand"] },
    { name: "/left/state", types: ["t"], publishers: ["/left/arm"], subscribers: ["/base"] },
    { name: "/move/_action/feedback", types: ["t"], publishers: ["/base"], subscribers: ["/talker"] },
    { name: "/move/_action/status", types: ["t"], publishers: ["/base"], subscribers: ["/talker"] },
    { name: "/rosout", types: ["t"], publishers: ["/base", "/talker"], subscribers: ["/left/arm"] },
    { name: "/tf", types: ["t"], publishers: ["/base"], subscribers: ["/talker"] },
  ],
};
const OPTIONS: GraphOptions = { mode: "active", debug: false, tf: true, grouped: false, openGroups: new Set() };

function labels(options: Partial<GraphOptions>): string[] {
  return buildGraph(GRAPH, { ...OPTIONS, ...options }).vertices.map(({ kind, label }) => `${kind} ${label}`);
}

describe("the drawn graph", () => {
  it("has nodes and the topics between them", () => {
    expect(labels({})).toEqual([
      "node /base",
      "node /left/arm",
      "node /left/hand",
      "node /talker",
      "topic /chatter",
      "topic /left/grip",
      "topic /left/state",
      "action /move",
      "topic /tf",
    ]);
  });

  it("applies the filters", () => {
    expect(labels({ mode: "all" })).toContain("topic /echo");
    expect(labels({ debug: true })).toContain("topic /rosout");
    expect(labels({ tf: false })).not.toContain("topic /tf");
  });

  it("connects nodes directly if topics are not shown", () => {
    const { vertices, edges } = buildGraph(GRAPH, { ...OPTIONS, mode: "nodes" });
    expect(vertices.every(({ kind }) => kind === "node")).toBe(true);
    expect(edges).toContainEqual({ source: "node:/base", target: "node:/talker", topics: ["/move", "/tf"] });
  });

  it("merges the nodes of a namespace, including the topics between them", () => {
    const { vertices, edges } = buildGraph(GRAPH, { ...OPTIONS, grouped: true });
    expect(vertices).toContainEqual({ id: "group:/left", kind: "group", label: "/left/", count: 2 });
    expect(vertices.map(({ label }) => label)).not.toContain("/left/grip");
    expect(edges).toContainEqual({ source: "group:/left", target: "topic:/left/state", topics: [] });
    expect(labels({ grouped: true, openGroups: new Set(["/left"]) })).toContain("node /left/hand");
  });
});

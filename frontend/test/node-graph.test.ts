import { describe, expect, it } from "vitest";
import type { NodeGraph } from "../src/protocol";
import { layOutLayers, type Layout, type Link } from "../src/state/monitor/graph-layout";
import { buildGraph, type GraphOptions } from "../src/state/monitor/graph-model";
import { fitIsotonic } from "../src/state/monitor/isotonic";

const createBox = (id: string): { id: string; width: number; height: number } => ({ id, width: 100, height: 28 });
const createLink = (source: string, target: string): Link => ({ source, target });

function listOverlaps({ boxes }: Layout): string[] {
  const boxList = [...boxes.values()];
  return boxList.flatMap((a, index) =>
    boxList
      .slice(index + 1)
      .filter((b) => Math.abs(a.x - b.x) < (a.width + b.width) / 2 && Math.abs(a.y - b.y) < (a.height + b.height) / 2)
      .map((b) => `${a.id} ${b.id}`),
  );
}

describe("the layout", () => {
  it("goes from left to right", () => {
    const { boxes, routes } = layOutLayers(["a", "b", "c"].map(createBox), [createLink("a", "b"), createLink("b", "c")]);
    const xs = ["a", "b", "c"].map((id) => boxes.get(id)?.x ?? 0);
    expect(xs[0]).toBeLessThan(xs[1] ?? 0);
    expect(xs[1]).toBeLessThan(xs[2] ?? 0);
    const [firstPoint, lastPoint] = [routes[0]?.points[0], routes[0]?.points.at(-1)];
    expect(firstPoint?.[0]).toBe((xs[0] ?? 0) + 50);
    expect(lastPoint?.[0]).toBe((xs[1] ?? 0) - 50);
  });

  it("keeps boxes apart and within the drawing", () => {
    const ids = Array.from({ length: 40 }, (_, index) => `n${index}`);
    const links = ids.flatMap((id, index) => [createLink(id, `n${(index * 7 + 3) % 40}`), createLink(id, `n${(index * 3 + 11) % 40}`)]);
    const layout = layOutLayers(ids.map(createBox), links);
    expect(layout.boxes.size).toBe(40);
    expect(listOverlaps(layout)).toEqual([]);
    for (const { x, y: yOf, width, height } of layout.boxes.values()) {
      expect(x - width / 2).toBeGreaterThanOrEqual(-1e-6);
      expect(yOf - height / 2).toBeGreaterThanOrEqual(-1e-6);
      expect(x + width / 2).toBeLessThanOrEqual(layout.width + 1e-6);
      expect(yOf + height / 2).toBeLessThanOrEqual(layout.height + 1e-6);
    }
  });

  it("handles cycles, and separates two links between the same boxes", () => {
    const layout = layOutLayers(["a", "b"].map(createBox), [createLink("a", "b"), createLink("b", "a")]);
    const [forthRoute, backRoute] = layout.routes;
    expect(forthRoute?.points[0]?.[1]).not.toBe(backRoute?.points[0]?.[1]);
    expect(backRoute?.points[0]?.[0]).toBeGreaterThan(backRoute?.points.at(-1)?.[0] ?? 0);
  });

  it("removes avoidable crossings", () => {
    const layout = layOutLayers(["a", "b", "x", "y"].map(createBox), [createLink("a", "y"), createLink("b", "x")]);
    const yOf = (id: string): number => layout.boxes.get(id)?.y ?? 0;
    expect(Math.sign(yOf("a") - yOf("b"))).toBe(Math.sign(yOf("y") - yOf("x")));
  });

  it("routes long links around the boxes between their ends", () => {
    const layout = layOutLayers(["a", "b", "c"].map(createBox), [createLink("a", "b"), createLink("b", "c"), createLink("a", "c")]);
    const route = layout.routes.find(({ source, target }) => source === "a" && target === "c");
    expect(route?.points).toHaveLength(3);
    const middleBox = layout.boxes.get("b");
    expect(Math.abs((route?.points[1]?.[1] ?? 0) - (middleBox?.y ?? 0))).toBeGreaterThan(14);
  });

  it("puts boxes without links below, in rows", () => {
    const ids = ["a", "b", ...Array.from({ length: 12 }, (_, index) => `alone${index}`)];
    const layout = layOutLayers(ids.map(createBox), [createLink("a", "b")]);
    expect(listOverlaps(layout)).toEqual([]);
    const heights = ids.slice(2).map((id) => layout.boxes.get(id)?.y ?? 0);
    expect(Math.min(...heights)).toBeGreaterThan(layout.boxes.get("a")?.y ?? 0);
    expect(new Set(heights).size).toBeGreaterThan(1);
  });

  it("of an empty graph is empty", () => {
    expect(layOutLayers([], [])).toMatchObject({ width: 0, height: 0 });
  });

  it("is fast for hundreds of nodes", () => {
    const ids = Array.from({ length: 300 }, (_, index) => `n${index}`);
    const links = ids.slice(1).map((id, index) => createLink(`n${Math.floor(index / 3)}`, id));
    const startTime = performance.now();
    layOutLayers(ids.map(createBox), links);
    expect(performance.now() - startTime).toBeLessThan(1000);
  });
});

describe("averaging unordered neighbors", () => {
  it("does not change ordered values", () => expect(fitIsotonic([1, 2, 2, 5])).toEqual([1, 2, 2, 5]));
  it("averages values out of order", () => expect(fitIsotonic([3, 1, 2, 10])).toEqual([2, 2, 2, 10]));
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
const OPTIONS: GraphOptions = { mode: "active", showsDebug: false, showsTf: true, groupsNamespaces: false, openGroups: new Set() };

function listLabels(options: Partial<GraphOptions>): string[] {
  return buildGraph(GRAPH, { ...OPTIONS, ...options }).vertices.map(({ kind, label }) => `${kind} ${label}`);
}

describe("the drawn graph", () => {
  it("has nodes and the topics between them", () => {
    expect(listLabels({})).toEqual([
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
    expect(listLabels({ mode: "all" })).toContain("topic /echo");
    expect(listLabels({ showsDebug: true })).toContain("topic /rosout");
    expect(listLabels({ showsTf: false })).not.toContain("topic /tf");
  });

  it("connects nodes directly if topics are not shown", () => {
    const { vertices, edges } = buildGraph(GRAPH, { ...OPTIONS, mode: "nodes" });
    expect(vertices.every(({ kind }) => kind === "node")).toBe(true);
    expect(edges).toContainEqual({ source: "node:/base", target: "node:/talker", topics: ["/move", "/tf"] });
  });

  it("merges the nodes of a namespace, including the topics between them", () => {
    const { vertices, edges } = buildGraph(GRAPH, { ...OPTIONS, groupsNamespaces: true });
    expect(vertices).toContainEqual({ id: "group:/left", kind: "group", label: "/left/", count: 2 });
    expect(vertices.map(({ label }) => label)).not.toContain("/left/grip");
    expect(edges).toContainEqual({ source: "group:/left", target: "topic:/left/state", topics: [] });
    expect(listLabels({ groupsNamespaces: true, openGroups: new Set(["/left"]) })).toContain("node /left/hand");
  });
});

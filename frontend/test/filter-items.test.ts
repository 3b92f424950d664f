import { expect, it } from "vitest";
import { filterItems } from "../src/tree/filter-items";
import type { TreeItem } from "../src/tree/tree-item";

function item(name: string, ...children: TreeItem[]): TreeItem {
  const base = { key: name, name, kind: "group" as const, value: null, description: "" };
  return children.length > 0 ? { ...base, children: () => children } : base;
}

const ITEMS = [item("Grid", item("Alpha"), item("Offset", item("X"))), item("Laser", item("Topic", item("Depth")))];

function names(items: readonly TreeItem[]): unknown {
  return items.map((each) => (each.children ? [each.name, each.isForcedOpen ?? false, names(each.children())] : each.name));
}

it("shows everything for an empty text", () => {
  expect(filterItems(ITEMS, "  ")).toBe(ITEMS);
});

it("unfolds the ancestors of items whose name has the text", () => {
  expect(names(filterItems(ITEMS, "dep"))).toEqual([["Laser", true, [["Topic", true, ["Depth"]]]]]);
});

it("keeps items below a match, folded as they were", () => {
  expect(names(filterItems(ITEMS, "OFF"))).toEqual([["Grid", true, [["Offset", false, ["X"]]]]]);
});

it("shows nothing if nothing matches", () => {
  expect(filterItems(ITEMS, "camera")).toEqual([]);
});

it("keeps values live that are read when shown", () => {
  let now = 1;
  const frame: TreeItem = { ...item("Position", item("X")), get value() { return now; } };
  const [shown] = filterItems([frame], "x");
  now = 2;
  expect(shown?.value).toBe(2);
});

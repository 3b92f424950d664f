import { expect, it } from "vitest";
import { filterItems } from "../src/tree/filter-items";
import type { TreeItem } from "../src/tree/tree-item";

function createItem(name: string, ...children: TreeItem[]): TreeItem {
  const base = { key: name, name, kind: "group" as const, value: null, description: "" };
  return children.length > 0 ? { ...base, children: () => children } : base;
}

const ITEMS = [
  createItem("Grid", createItem("Alpha"), createItem("Offset", createItem("X"))),
  createItem("Laser", createItem("Topic", createItem("Depth"))),
];

function listNames(items: readonly TreeItem[]): unknown {
  return items.map((item) => (item.children ? [item.name, item.isForcedOpen ?? false, listNames(item.children())] : item.name));
}

it("shows everything for an empty text", () => {
  expect(filterItems(ITEMS, "  ")).toBe(ITEMS);
});

it("unfolds the ancestors of items whose name has the text", () => {
  expect(listNames(filterItems(ITEMS, "dep"))).toEqual([["Laser", true, [["Topic", true, ["Depth"]]]]]);
});

it("keeps items below a match, folded as they were", () => {
  expect(listNames(filterItems(ITEMS, "OFF"))).toEqual([["Grid", true, [["Offset", false, ["X"]]]]]);
});

it("shows nothing if nothing matches", () => {
  expect(filterItems(ITEMS, "camera")).toEqual([]);
});

it("keeps values live that are read when shown", () => {
  let value = 1;
  const frame: TreeItem = { ...createItem("Position", createItem("X")), get value() { return value; } };
  const [filteredFrame] = filterItems([frame], "x");
  value = 2;
  expect(filteredFrame?.value).toBe(2);
});

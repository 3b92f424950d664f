import { expect, it } from "vitest";
import { filterItems } from "../src/tree/filter-items";
import type { TreeItem } from "../src/tree/tree-item";

function item(name: string, ...children: TreeItem[]): TreeItem {
  const base = { key: name, name, kind: "group" as const, value: null, description: "" };
  return children.length > 0 ? { ...base, children: () => children } : base;
}

const ITEMS = [item("Grid", item("Alpha"), item("Offset", item("X"))), item("Laser", item("Topic", item("Depth")))];

function names(items: readonly TreeItem[]): unknown {
  return items.map((each) => (each.children ? [each.name, each.open ?? false, names(each.children())] : each.name));
}

it("shows everything for nothing", () => {
  expect(filterItems(ITEMS, "  ")).toBe(ITEMS);
});

it("opens the way to what has the text in its name", () => {
  expect(names(filterItems(ITEMS, "dep"))).toEqual([["Laser", true, [["Topic", true, ["Depth"]]]]]);
});

it("keeps what is below a match, closed as it was", () => {
  expect(names(filterItems(ITEMS, "OFF"))).toEqual([["Grid", true, [["Offset", false, ["X"]]]]]);
});

it("shows nothing where there is nothing", () => {
  expect(filterItems(ITEMS, "camera")).toEqual([]);
});

it("leaves values live that are read when they are shown", () => {
  let now = 1;
  const frame: TreeItem = { ...item("Position", item("X")), get value() { return now; } };
  const [shown] = filterItems([frame], "x");
  now = 2;
  expect(shown?.value).toBe(2);
});

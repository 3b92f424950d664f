import type { TreeItem } from "./tree-item";

/** The items whose name has `text` in it, with their ancestors, opened, and all their descendants. */
export function filterItems(items: readonly TreeItem[], text: string): readonly TreeItem[] {
  const wanted = text.trim().toLowerCase();
  return wanted === "" ? items : items.flatMap((item) => filtered(item, wanted));
}

function filtered(item: TreeItem, wanted: string): TreeItem[] {
  if (item.name.toLowerCase().includes(wanted)) return [item];
  const below = (item.children?.() ?? []).flatMap((child) => filtered(child, wanted));
  if (below.length === 0) return [];
  // Its value may be one that is read each time it is shown.
  return [{ ...item, get value() { return item.value; }, open: true, children: () => below }];
}

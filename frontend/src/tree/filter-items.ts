import type { TreeItem } from "./tree-item";

/** Returns the items whose name contains `text`, with their ancestors, unfolded, and all their descendants. */
export function filterItems(items: readonly TreeItem[], text: string): readonly TreeItem[] {
  const query = text.trim().toLowerCase();
  return query === "" ? items : items.flatMap((item) => matching(item, query));
}

function matching(item: TreeItem, query: string): TreeItem[] {
  if (item.name.toLowerCase().includes(query)) return [item];
  const below = (item.children?.() ?? []).flatMap((child) => matching(child, query));
  if (below.length === 0) return [];
  // Keep the getter: the value may be read each time it is shown.
  return [{ ...item, get value() { return item.value; }, open: true, children: () => below }];
}

import type { TreeItem } from "./tree-item";

/** Returns the items whose name contains `text`, with their ancestors, unfolded, and all their descendants. */
export function filterItems(items: readonly TreeItem[], text: string): readonly TreeItem[] {
  const query = text.trim().toLowerCase();
  return query === "" ? items : items.flatMap((item) => filterItem(item, query));
}

function filterItem(item: TreeItem, query: string): TreeItem[] {
  if (item.name.toLowerCase().includes(query)) return [item];
  const children = (item.children?.() ?? []).flatMap((child) => filterItem(child, query));
  if (children.length === 0) return [];
  // Keep the getter: a value that follows the scene is read each time it is shown.
  return [{ ...item, get value() { return item.value; }, isForcedOpen: true, children: () => children }];
}

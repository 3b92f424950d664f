import type { PropertyValue } from "../protocol";
import type { PropertyNode } from "../state/properties";
import type { TreeItem } from "./tree-item";

/** Returns the row of a property with the rows below it; an edit calls `set` with the property's ID. */
export function createPropertyItem(node: PropertyNode, set: (id: string, value: PropertyValue) => void): TreeItem {
  return {
    key: node.id,
    name: node.name,
    kind: node.kind,
    value: node.value,
    description: node.description,
    options: node.options,
    minimum: node.minimum,
    maximum: node.maximum,
    isReadOnly: node.isReadOnly,
    isExpanded: node.isExpanded,
    ...(node.children.length > 0 ? { children: () => node.children.map((child) => createPropertyItem(child, set)) } : {}),
    ...(node.isReadOnly ? {} : { set: (value: PropertyValue) => set(node.id, value) }),
  };
}

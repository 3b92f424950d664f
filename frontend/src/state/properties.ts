import type { Property, PropertyKind, PropertyValue, RowDetails, TopicOffer } from "../protocol";

/** A row of a property tree; only its value and options change. */
export class PropertyNode {
  readonly id: string;
  readonly name: string;
  readonly kind: PropertyKind;
  readonly description: string;
  readonly minimum: number | null;
  readonly maximum: number | null;
  readonly isReadOnly: boolean;
  readonly isExpanded: boolean;
  readonly children: readonly PropertyNode[];
  /** The kind of object that the row represents, if the page adds rows with details of it. */
  readonly details: RowDetails | null;
  /** The topics to offer, if not those of the display. */
  readonly topics: TopicOffer | null;
  value: PropertyValue;
  options: readonly string[];

  constructor(property: Property) {
    this.id = property.id;
    this.name = property.name;
    this.kind = property.kind;
    this.value = property.value;
    this.description = property.description;
    this.options = property.options;
    this.minimum = property.minimum;
    this.maximum = property.maximum;
    this.isReadOnly = property.read_only;
    this.isExpanded = property.expanded;
    this.details = property.details;
    this.topics = property.topics;
    this.children = property.children.map((child) => new PropertyNode(child));
  }

  /** Yields this row and all rows below it. */
  *walk(): Generator<PropertyNode> {
    yield this;
    for (const child of this.children) yield* child.walk();
  }
}

/** Rows found by their names, as in RViz's documentation: `number(1, "Line Style", "Line Width")`. */
export class PropertyRows {
  private byName: Map<string, PropertyNode>;

  constructor(public nodes: readonly PropertyNode[]) {
    this.byName = new Map(nodes.map((node) => [node.name, node]));
  }

  find(...path: readonly string[]): PropertyNode | undefined {
    const [firstName, ...childPath] = path;
    let node = firstName === undefined ? undefined : this.byName.get(firstName);
    for (const name of childPath) node = node?.children.find((child) => child.name === name);
    return node;
  }

  /** Returns the value of a number row, or `fallback` if there is none. */
  number(fallback: number, ...path: readonly string[]): number {
    const value = this.find(...path)?.value;
    return typeof value === "number" ? value : fallback;
  }

  bool(fallback: boolean, ...path: readonly string[]): boolean {
    const value = this.find(...path)?.value;
    return typeof value === "boolean" ? value : fallback;
  }

  text(fallback: string, ...path: readonly string[]): string {
    const value = this.find(...path)?.value;
    return typeof value === "string" ? value : fallback;
  }

  /** Returns X, Y and Z below the row at `path`. */
  vector(...path: readonly string[]): [number, number, number] {
    return [this.number(0, ...path, "X"), this.number(0, ...path, "Y"), this.number(0, ...path, "Z")];
  }
}

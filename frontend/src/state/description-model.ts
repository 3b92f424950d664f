import type { Description, JointDetails, LinkDetails, SourceRange, Written } from "../protocol";

/** A link or joint of the robot in a display. */
export interface ElementName {
  readonly display: string;
  readonly kind: "link" | "joint";
  readonly name: string;
}

/** The key of the expanded text among the files. */
export const EXPANDED_TEXT_KEY = "";

/** A description as a tree, with the places where it is written. */
export class DescriptionModel {
  readonly links: ReadonlyMap<string, LinkDetails>;
  readonly joints: ReadonlyMap<string, JointDetails>;
  private readonly jointsByParent = new Map<string, JointDetails[]>();
  private readonly depths = new Map<string, number>();
  /** The source ranges in each file; elements from a macro share a range. */
  private readonly ranges = new Map<string, { range: SourceRange; element: ElementName }[]>();

  constructor(readonly description: Description) {
    this.links = new Map(description.links.map((link) => [link.name, link]));
    this.joints = new Map(description.joints.map((joint) => [joint.name, joint]));
    for (const joint of [...description.joints].sort((a, b) => (a.name < b.name ? -1 : 1))) {
      // If several joints have the same child link, urdfdom keeps one of them.
      if (this.links.get(joint.child)?.parent_joint !== joint.name) continue;
      const siblings = this.jointsByParent.get(joint.parent);
      if (siblings) siblings.push(joint);
      else this.jointsByParent.set(joint.parent, [joint]);
    }
    this.computeDepths();
    for (const link of description.links) this.addRanges("link", link.name, link.written);
    for (const joint of description.joints) this.addRanges("joint", joint.name, joint.written);
  }

  get display(): string {
    return this.description.display;
  }

  /** Returns the child joints of a link, sorted by name as in urdfdom. */
  childJointsOf(link: string): readonly JointDetails[] {
    return this.jointsByParent.get(link) ?? [];
  }

  parentJointOf(link: string): JointDetails | undefined {
    const name = this.links.get(link)?.parent_joint;
    return name === undefined || name === null ? undefined : this.joints.get(name);
  }

  /** Returns the number of joints between the root and a link. */
  depthOf(link: string): number {
    return this.depths.get(link) ?? 0;
  }

  get maxDepth(): number {
    return Math.max(0, ...this.depths.values());
  }

  sourceOf(element: ElementName): Written | undefined {
    const elements: ReadonlyMap<string, { written: Written }> = element.kind === "link" ? this.links : this.joints;
    return elements.get(element.name)?.written;
  }

  /**
   * Returns the links and joints written on a line of a file, in the order of the description; a line of a macro may
   * yield several.
   */
  elementsAt(file: string, line: number): ElementName[] {
    const ranges = this.ranges.get(file) ?? [];
    return ranges.filter(({ range }) => range.line <= line && line <= range.end_line).map(({ element }) => element);
  }

  private computeDepths(): void {
    const stack: [string, number][] = [[this.description.root, 0]];
    for (let next = stack.pop(); next; next = stack.pop()) {
      const [link, depth] = next;
      if (this.depths.has(link)) continue;
      this.depths.set(link, depth);
      for (const joint of this.childJointsOf(link)) stack.push([joint.child, depth + 1]);
    }
  }

  private addRanges(kind: "link" | "joint", name: string, { expanded, origin }: Written): void {
    for (const range of [expanded, origin]) {
      if (!range) continue;
      const entry = { range, element: { display: this.display, kind, name } };
      const ranges = this.ranges.get(range.file);
      if (ranges) ranges.push(entry);
      else this.ranges.set(range.file, [entry]);
    }
  }
}

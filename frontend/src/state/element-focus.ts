import type { RobotScene } from "../protocol";
import { Signal } from "../signal";
import type { ElementName } from "./description-model";
import type { PageMemory } from "./page-memory";
import type { SelectionState } from "./selection";

/**
 * The link or joint that the description panels show. Selecting a joint selects its child link in the scene; selecting
 * a link in the scene makes it the element here.
 */
export class ElementFocus {
  readonly changed = new Signal();
  readonly hoverChanged = new Signal();
  private joint: ElementName | null = null;
  private hovered: ElementName | null = null;

  constructor(
    private readonly selection: SelectionState,
    private readonly robots: ReadonlyMap<string, RobotScene>,
  ) {
    selection.changed.on(() => {
      if (this.joint && this.linkOf(this.joint) !== selection.selectedLink?.link.name) this.joint = null;
      this.changed.emit();
    });
  }

  /** Preserves the selected joint across reloads of the page. */
  preserveIn(memory: PageMemory): void {
    memory.preserve("joint", () => this.joint, (joint) => (this.joint = joint));
  }

  get current(): ElementName | null {
    if (this.joint) return this.joint;
    const selectedLink = this.selection.selectedLink;
    return selectedLink && { display: selectedLink.display, kind: "link", name: selectedLink.link.name };
  }

  /** The element under the pointer in a list or tree. */
  get hoveredElement(): ElementName | null {
    return this.hovered;
  }

  select(element: ElementName | null): void {
    this.joint = element?.kind === "joint" ? element : null;
    const name = element && this.linkOf(element);
    const link = element && this.robots.get(element.display)?.links.find((candidate) => candidate.name === name);
    const previous = this.selection.selectedLink;
    this.selection.select(element && link ? { display: element.display, link } : null);
    // The link is the same, but the selected element may be another of its joints, or the link itself.
    if (previous?.link.name === this.selection.selectedLink?.link.name) this.changed.emit();
  }

  setHovered(element: ElementName | null): void {
    if (isSameElement(element, this.hovered)) return;
    this.hovered = element;
    this.hoverChanged.emit();
  }

  /** Returns the link that represents an element in the scene. */
  linkOf(element: ElementName): string | undefined {
    if (element.kind === "link") return element.name;
    const links = this.robots.get(element.display)?.links ?? [];
    return links.find((link) => link.parent_joint === element.name)?.name;
  }
}

export function isSameElement(a: ElementName | null, b: ElementName | null): boolean {
  return a === b || (a !== null && b !== null && a.display === b.display && a.kind === b.kind && a.name === b.name);
}

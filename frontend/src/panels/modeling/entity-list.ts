import { h } from "../../dom";
import { createIcon, type IconName } from "../../icons";
import type { WorldEntity } from "../../protocol";
import type { Modeling } from "../../state/modeling/modeling";
import type { Shape } from "../../state/modeling/shapes";
import { strings } from "../../strings";
import { VirtualRows } from "../../widgets/virtual-rows";

const ROW_HEIGHT_PX = 23;
const SHAPE_ICONS: Readonly<Record<Shape, IconName>> = {
  box: "shapeBox",
  cylinder: "shapeCylinder",
  sphere: "shapeSphere",
  wall: "shapeWall",
  ramp: "shapeRamp",
};

/** The list of all entities in the world, by name; several can be selected, as in the scene. */
export class EntityList {
  readonly element: HTMLElement;
  private readonly rows: VirtualRows;
  private entities: readonly WorldEntity[] = [];
  /** The row from which arrow keys continue, and the row where a range begins. */
  private currentRow = 0;
  private anchorRow = 0;

  constructor(private readonly modeling: Modeling) {
    this.rows = new VirtualRows("entity-list", ROW_HEIGHT_PX, (index) => this.createRow(index));
    this.element = this.rows.element;
    this.element.setAttribute("role", "listbox");
    this.element.setAttribute("aria-multiselectable", "true");
    this.element.setAttribute("aria-label", strings.modeling.entities);
    this.element.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.element.addEventListener("mousedown", (event) => this.onMouseDown(event));
    modeling.changed.on(() => this.show());
    modeling.selectionChanged.on(() => this.reveal());
    this.show();
  }

  private show(): void {
    this.entities = this.modeling.entities;
    this.rows.refresh(this.entities.length);
    this.updateActiveDescendant();
  }

  private reveal(): void {
    const lastSelected = this.modeling.selectedNames.at(-1);
    const index = this.entities.findIndex(({ name }) => name === lastSelected);
    if (index >= 0 && index !== this.currentRow) {
      this.currentRow = this.anchorRow = index;
      this.rows.reveal(index);
    }
    this.rows.refresh();
    this.updateActiveDescendant();
  }

  private createRow(index: number): HTMLElement {
    const entity = this.entities[index];
    const name = entity?.name ?? "";
    const isSelected = this.modeling.selectedNames.includes(name);
    const row = h(
      "div",
      { class: isSelected ? "entity-row selected" : "entity-row", role: "option", title: name, aria: { selected: String(isSelected) } },
      createIcon(entity ? chooseIcon(entity) : "unknown"),
      h("span", {}, name),
    );
    row.id = `entity-${index}`;
    row.addEventListener("click", (event) => this.selectRow(index, event.shiftKey, event.ctrlKey || event.metaKey));
    return row;
  }

  /** Stops the browser from selecting text on Shift, which would start at the last edited field. */
  private onMouseDown(event: MouseEvent): void {
    if (!event.shiftKey) return;
    event.preventDefault();
    this.element.focus({ preventScroll: true });
  }

  private selectRow(index: number, extendsRange: boolean, isToggle: boolean): void {
    const entity = this.entities[index];
    if (!entity) return;
    this.currentRow = index;
    if (!extendsRange) this.anchorRow = index;
    const [start, end] = [Math.min(this.anchorRow, index), Math.max(this.anchorRow, index)];
    if (isToggle) this.modeling.select([entity.name], "toggle");
    else this.modeling.select(extendsRange ? this.entities.slice(start, end + 1).map(({ name }) => name) : [entity.name]);
    this.updateActiveDescendant();
  }

  private updateActiveDescendant(): void {
    if (this.entities.length > 0) this.element.setAttribute("aria-activedescendant", `entity-${this.currentRow}`);
    else this.element.removeAttribute("aria-activedescendant");
  }

  private onKeyDown(event: KeyboardEvent): void {
    const lastIndex = this.entities.length - 1;
    const targetIndex = { ArrowDown: this.currentRow + 1, ArrowUp: this.currentRow - 1, Home: 0, End: lastIndex }[event.key];
    if (targetIndex === undefined || lastIndex < 0) return;
    event.preventDefault();
    const index = Math.max(0, Math.min(lastIndex, targetIndex));
    this.selectRow(index, event.shiftKey, false);
    this.rows.reveal(index);
  }
}

function chooseIcon({ kind, shape, parts, address }: WorldEntity): IconName {
  if (kind === "light") return "bulb";
  if (shape) return SHAPE_ICONS[shape];
  return parts.length > 0 ? "group" : address === null ? "cube" : "library";
}

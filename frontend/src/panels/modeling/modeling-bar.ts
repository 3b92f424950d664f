import { button, h } from "../../dom";
import { icon, type IconName } from "../../icons";
import type { GizmoMode, Modeling, Placing } from "../../state/modeling/modeling";
import type { NewKind } from "../../state/modeling/shapes";
import { strings } from "../../strings";
import { keyText, type Shortcut } from "../../widgets/shortcuts";
import { ModelDialog } from "./model-dialog";
import { WORLD_KEYS, type WorldCommands } from "./world-commands";

/** The entities that can be added to the world, except models. */
const PALETTE: readonly (readonly [Exclude<NewKind, "model">, IconName])[] = [
  ["box", "shapeBox"],
  ["cylinder", "shapeCylinder"],
  ["sphere", "shapeSphere"],
  ["wall", "shapeWall"],
  ["ramp", "shapeRamp"],
  ["point_light", "bulb"],
  ["directional_light", "sun"],
  ["spot_light", "spot"],
];
const MODES: readonly (readonly [GizmoMode, IconName])[] = [
  ["translate", "move"],
  ["rotate", "turn"],
  ["scale", "scale"],
];

/** The toolbar over the scene while the world is modeled: entities to add, modes of the gizmo, undo and save. */
export class ModelingBar {
  readonly element: HTMLElement;
  private readonly palette = new Map<NewKind, HTMLButtonElement>();
  private readonly modes = new Map<GizmoMode, HTMLButtonElement>();
  private readonly snap: HTMLButtonElement;
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;
  private readonly save: HTMLButtonElement;

  constructor(
    private readonly modeling: Modeling,
    commands: WorldCommands,
  ) {
    const texts = strings.modeling;
    for (const [kind, name] of PALETTE) this.palette.set(kind, this.addButton(kind, name));
    this.palette.set("model", tool(texts.addModel, "library", () => new ModelDialog(modeling).open()));
    for (const [mode, name] of MODES) {
      this.modes.set(mode, tool(withKeys(texts.modes[mode], WORLD_KEYS[mode]), name, () => (modeling.gizmo = mode)));
    }
    this.snap = tool(texts.snap, "magnet", () => (modeling.snapping.isEnabled = !modeling.snapping.isEnabled));
    this.undo = tool(withKeys(texts.undo, WORLD_KEYS.undo), "undo", () => modeling.undo());
    this.redo = tool(withKeys(texts.redo, WORLD_KEYS.redo), "redo", () => modeling.redo());
    this.save = tool(withKeys(texts.save, WORLD_KEYS.save), "save", () => commands.save());
    const line = (): HTMLElement => h("span", { class: "bar-line" });
    const tools = [...this.palette.values(), line(), ...this.modes.values(), this.snap, line(), this.undo, this.redo, this.save];
    this.element = h("div", { class: "simulation-tools modeling-tools", role: "toolbar", aria: { label: texts.label } }, ...tools);
    for (const signal of [modeling.changed, modeling.selectionChanged, modeling.toolChanged, modeling.snapping.changed]) {
      signal.on(() => this.show());
    }
    this.show();
  }

  private show(): void {
    const { modeling } = this;
    this.element.hidden = !modeling.isActive;
    for (const [kind, each] of this.palette) setPressed(each, modeling.placing?.kind === kind);
    for (const [mode, each] of this.modes) setPressed(each, modeling.gizmo === mode);
    const scale = this.modes.get("scale");
    if (scale) scale.disabled = modeling.selectedNames.length > 0 && !modeling.canScale;
    setPressed(this.snap, modeling.snapping.isEnabled);
    this.undo.disabled = !modeling.canUndo;
    this.redo.disabled = !modeling.canRedo;
    this.save.classList.toggle("unsaved", modeling.isUnsaved);
  }

  /**
   * Returns a button that adds an entity: a click selects it for placing, dragging drops it onto the ground, and the
   * keyboard adds it at the center of the scene.
   */
  private addButton(kind: Exclude<NewKind, "model">, name: IconName): HTMLButtonElement {
    const { modeling } = this;
    const texts = strings.modeling;
    const placing: Placing = { kind, address: "" };
    const toolButton = tool(kind === "wall" ? texts.addWall : texts.add(texts.kinds[kind]), name, () => undefined);
    toolButton.setAttribute("aria-label", texts.kinds[kind]);
    let wasDropped = false;
    toolButton.addEventListener("click", (event) => {
      if (wasDropped) return;
      if (event.detail === 0) modeling.drop({ placing, position: null });
      else modeling.startPlacing(modeling.placing?.kind === kind ? null : placing);
    });
    toolButton.addEventListener("pointerup", ({ clientX: x, clientY: y }) => {
      if (!(document.elementFromPoint(x, y) instanceof HTMLCanvasElement)) return;
      wasDropped = true; // a click follows
      setTimeout(() => (wasDropped = false));
      modeling.drop({ placing, position: { x, y } });
    });
    // Without the capture, dragging a finger would scroll the page, and the button would receive no further events.
    toolButton.addEventListener("pointerdown", ({ pointerId }) => toolButton.setPointerCapture(pointerId));
    return toolButton;
  }
}

function tool(label: string, name: IconName, run: () => void): HTMLButtonElement {
  return button(label, run, "scene-tool small", icon(name));
}

function setPressed(element: HTMLButtonElement, on: boolean): void {
  element.setAttribute("aria-pressed", String(on));
  element.classList.toggle("active", on);
}

function withKeys(label: string, shortcut: Shortcut): string {
  return `${label} (${keyText(shortcut)})`;
}

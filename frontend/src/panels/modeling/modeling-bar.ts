import { createButton, h } from "../../dom";
import { createIcon, type IconName } from "../../icons";
import type { GizmoMode, Modeling, Placing } from "../../state/modeling/modeling";
import type { NewKind } from "../../state/modeling/shapes";
import { strings } from "../../strings";
import { formatShortcut, type Shortcut } from "../../widgets/shortcuts";
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
  private readonly addButtons = new Map<NewKind, HTMLButtonElement>();
  private readonly modeButtons = new Map<GizmoMode, HTMLButtonElement>();
  private readonly snapButton: HTMLButtonElement;
  private readonly undoButton: HTMLButtonElement;
  private readonly redoButton: HTMLButtonElement;
  private readonly saveButton: HTMLButtonElement;

  constructor(
    private readonly modeling: Modeling,
    commands: WorldCommands,
  ) {
    const texts = strings.modeling;
    for (const [kind, name] of PALETTE) this.addButtons.set(kind, this.createAddButton(kind, name));
    this.addButtons.set("model", createTool(texts.addModel, "library", () => new ModelDialog(modeling).open()));
    for (const [mode, name] of MODES) {
      this.modeButtons.set(mode, createTool(appendKeys(texts.modes[mode], WORLD_KEYS[mode]), name, () => (modeling.gizmo = mode)));
    }
    this.snapButton = createTool(texts.snap, "magnet", () => (modeling.snapping.isEnabled = !modeling.snapping.isEnabled));
    this.undoButton = createTool(appendKeys(texts.undo, WORLD_KEYS.undo), "undo", () => modeling.undo());
    this.redoButton = createTool(appendKeys(texts.redo, WORLD_KEYS.redo), "redo", () => modeling.redo());
    this.saveButton = createTool(appendKeys(texts.save, WORLD_KEYS.save), "save", () => commands.save());
    const createSeparator = (): HTMLElement => h("span", { class: "bar-line" });
    const tools = [...this.addButtons.values(), createSeparator(), ...this.modeButtons.values(), this.snapButton, createSeparator(), this.undoButton, this.redoButton, this.saveButton];
    this.element = h("div", { class: "simulation-tools modeling-tools", role: "toolbar", aria: { label: texts.label } }, ...tools);
    for (const signal of [modeling.changed, modeling.selectionChanged, modeling.toolChanged, modeling.snapping.changed]) {
      signal.on(() => this.show());
    }
    this.show();
  }

  private show(): void {
    const { modeling } = this;
    this.element.hidden = !modeling.isActive;
    for (const [kind, toolButton] of this.addButtons) setPressed(toolButton, modeling.placing?.kind === kind);
    for (const [mode, toolButton] of this.modeButtons) setPressed(toolButton, modeling.gizmo === mode);
    const scaleButton = this.modeButtons.get("scale");
    if (scaleButton) scaleButton.disabled = modeling.selectedNames.length > 0 && !modeling.canScale;
    setPressed(this.snapButton, modeling.snapping.isEnabled);
    this.undoButton.disabled = !modeling.canUndo;
    this.redoButton.disabled = !modeling.canRedo;
    this.saveButton.classList.toggle("unsaved", modeling.isUnsaved);
  }

  /**
   * Returns a button that adds an entity: a click selects it for placing, dragging drops it onto the ground, and the
   * keyboard adds it at the center of the scene.
   */
  private createAddButton(kind: Exclude<NewKind, "model">, name: IconName): HTMLButtonElement {
    const { modeling } = this;
    const texts = strings.modeling;
    const placing: Placing = { kind, address: "" };
    const toolButton = createTool(kind === "wall" ? texts.addWall : texts.add(texts.kinds[kind]), name, () => undefined);
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
    // Without pointer capture, dragging a finger would scroll the page, and the button would get no further events.
    toolButton.addEventListener("pointerdown", ({ pointerId }) => toolButton.setPointerCapture(pointerId));
    return toolButton;
  }
}

function createTool(label: string, name: IconName, run: () => void): HTMLButtonElement {
  return createButton(label, run, "scene-tool small", createIcon(name));
}

function setPressed(element: HTMLButtonElement, isPressed: boolean): void {
  element.setAttribute("aria-pressed", String(isPressed));
  element.classList.toggle("active", isPressed);
}

function appendKeys(label: string, shortcut: Shortcut): string {
  return `${label} (${formatShortcut(shortcut)})`;
}

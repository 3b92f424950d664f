import { createButton, h } from "../../dom";
import { createIcon, type IconName } from "../../icons";
import type { AngleUnits } from "../../state/angle-unit";
import type { Modeling } from "../../state/modeling/modeling";
import { ANGLE_STEPS_DEG, LENGTH_STEPS_M } from "../../state/modeling/snapping";
import { strings } from "../../strings";
import { TreeView } from "../../tree/tree-view";
import { createSelect } from "../../widgets/controls";
import { formatShortcut, type Shortcut } from "../../widgets/shortcuts";
import { UnitSwitch } from "../../widgets/unit-switch";
import type { Panel } from "../panel";
import { shortenPath } from "../place";
import { createEntityItems } from "./entity-items";
import { EntityList } from "./entity-list";
import { WORLD_KEYS, type WorldCommands } from "./world-commands";

/** The models and lights of the world being edited, and the properties of the selection. */
export class WorldPanel implements Panel {
  readonly id = "world";
  readonly icon = "build";
  readonly element: HTMLElement;
  private readonly inactiveView: HTMLElement;
  private readonly activeView: HTMLElement;
  private readonly fileLabel = h("span", { class: "world-file" });
  private readonly unsavedMark = h("span", { class: "world-unsaved", title: strings.modeling.unsaved, role: "img", aria: { label: strings.modeling.unsaved } }, "●");
  private readonly emptyNote = h("p", { class: "hint empty" }, strings.modeling.empty);
  private readonly actions: readonly (readonly [HTMLButtonElement, () => boolean])[];

  constructor(
    private readonly modeling: Modeling,
    angles: AngleUnits,
    commands: WorldCommands,
  ) {
    const texts = strings.modeling;
    const startButton = createButton(texts.startEditing, () => modeling.setActive(true), "tool framed", texts.start);
    this.inactiveView = h("div", { class: "world-off" }, h("p", { class: "hint" }, texts.inactiveHint), startButton);
    const hasSelection = (): boolean => modeling.selectedNames.length > 0;
    this.actions = [
      [createAction(texts.duplicate, WORLD_KEYS.duplicate, "duplicate", () => modeling.duplicate()), hasSelection],
      [createAction(texts.remove, WORLD_KEYS.remove, "remove", () => modeling.remove()), hasSelection],
      [createAction(texts.group, WORLD_KEYS.group, "group", () => modeling.groupSelected()), () => modeling.canGroup],
      [createAction(texts.ungroup, WORLD_KEYS.ungroup, "ungroup", () => modeling.ungroupSelected()), () => modeling.canUngroup],
    ];
    const toolbar = h("div", { class: "toolbar", role: "toolbar", aria: { label: texts.panel } }, ...this.actions.map(([actionButton]) => actionButton));
    const saveAsButton = createAction(texts.saveAs, WORLD_KEYS.saveAs, "download", () => commands.saveAs());
    const header = h("div", { class: "world-head" }, createIcon("file"), this.fileLabel, this.unsavedMark, h("span", { class: "spacer" }), saveAsButton);
    const tree = new TreeView(texts.properties, () => createEntityItems(modeling, angles), () => []);
    this.activeView = h("div", { class: "world-work" }, header, toolbar, this.emptyNote, new EntityList(modeling).element, tree.element, this.createGridControls(angles));
    this.element = h("div", { class: "panel world-panel" }, this.inactiveView, this.activeView);
    modeling.changed.on(() => this.show());
    modeling.selectionChanged.on(() => this.show());
    for (const signal of [modeling.changed, modeling.selectionChanged, angles.changed]) signal.on(tree.refresh);
    this.show();
  }

  private show(): void {
    const { isActive, file, isUnsaved, entities } = this.modeling;
    this.inactiveView.hidden = isActive;
    this.activeView.hidden = !isActive;
    this.fileLabel.textContent = file === null ? strings.modeling.untitled : shortenPath(file);
    this.fileLabel.title = file ?? "";
    this.unsavedMark.hidden = !isUnsaved;
    this.emptyNote.hidden = entities.length > 0;
    for (const [actionButton, isPossible] of this.actions) actionButton.disabled = !isPossible();
  }

  private createGridControls(angles: AngleUnits): HTMLElement {
    const texts = strings.modeling;
    const { snapping } = this.modeling;
    const createStepOptions = (values: readonly number[], unit: string): (readonly [string, string])[] => values.map((value) => [String(value), `${value}${unit}`]);
    const lengthSelect = createSelect(texts.lengthStep, createStepOptions(LENGTH_STEPS_M, " m"), (value) => (snapping.meters = Number(value)));
    const angleSelect = createSelect(texts.angleStep, createStepOptions(ANGLE_STEPS_DEG, "°"), (value) => (snapping.degrees = Number(value)));
    const show = (): void => {
      lengthSelect.value = String(snapping.meters);
      angleSelect.value = String(snapping.degrees);
    };
    snapping.changed.on(show);
    show();
    return h("div", { class: "world-grid" }, createIcon("magnet"), lengthSelect, angleSelect, h("span", { class: "spacer" }), new UnitSwitch(angles).element);
  }
}

function createAction(label: string, keys: Shortcut, name: IconName, run: () => void): HTMLButtonElement {
  return createButton(`${label} (${formatShortcut(keys)})`, run, "tool bare", createIcon(name));
}

import { button, h } from "../../dom";
import { icon, type IconName } from "../../icons";
import type { AngleUnits } from "../../state/angle-unit";
import type { Modelling } from "../../state/modelling/modelling";
import { ANGLE_STEPS, LENGTH_STEPS } from "../../state/modelling/snapping";
import { strings } from "../../strings";
import { TreeView } from "../../tree/tree-view";
import { choice } from "../../widgets/controls";
import { keyText, type Shortcut } from "../../widgets/shortcuts";
import { UnitSwitch } from "../../widgets/unit-switch";
import type { Panel } from "../panel";
import { shortPath } from "../place";
import { entityItems } from "./entity-items";
import { EntityList } from "./entity-list";
import { WORLD_KEYS, type WorldCommands } from "./world-commands";

/** The models and lights of the world being edited, and the properties of the selection. */
export class WorldPanel implements Panel {
  readonly id = "world";
  readonly icon = "build";
  readonly element: HTMLElement;
  private readonly inactiveView: HTMLElement;
  private readonly activeView: HTMLElement;
  private readonly file = h("span", { class: "world-file" });
  private readonly mark = h("span", { class: "world-unsaved", title: strings.modelling.unsaved, role: "img", aria: { label: strings.modelling.unsaved } }, "●");
  private readonly empty = h("p", { class: "hint empty" }, strings.modelling.empty);
  private readonly actions: readonly (readonly [HTMLButtonElement, () => boolean])[];

  constructor(
    private readonly modelling: Modelling,
    angles: AngleUnits,
    commands: WorldCommands,
  ) {
    const words = strings.modelling;
    const begin = button(words.begin, () => modelling.setActive(true), "tool framed", words.start);
    this.inactiveView = h("div", { class: "world-off" }, h("p", { class: "hint" }, words.off), begin);
    const any = (): boolean => modelling.selected.length > 0;
    this.actions = [
      [action(words.duplicate, WORLD_KEYS.duplicate, "duplicate", () => modelling.duplicate()), any],
      [action(words.remove, WORLD_KEYS.remove, "remove", () => modelling.remove()), any],
      [action(words.group, WORLD_KEYS.group, "group", () => modelling.group()), () => modelling.canGroup],
      [action(words.ungroup, WORLD_KEYS.ungroup, "ungroup", () => modelling.ungroup()), () => modelling.canUngroup],
    ];
    const toolbar = h("div", { class: "toolbar", role: "toolbar", aria: { label: words.panel } }, ...this.actions.map(([made]) => made));
    const saveAs = action(words.saveAs, WORLD_KEYS.saveAs, "download", () => commands.saveAs());
    const head = h("div", { class: "world-head" }, icon("file"), this.file, this.mark, h("span", { class: "spacer" }), saveAs);
    const tree = new TreeView(words.properties, () => entityItems(modelling, angles), () => []);
    this.activeView = h("div", { class: "world-work" }, head, toolbar, this.empty, new EntityList(modelling).element, tree.element, this.grid(angles));
    this.element = h("div", { class: "panel world-panel" }, this.inactiveView, this.activeView);
    modelling.changed.on(() => this.show());
    modelling.selectionChanged.on(() => this.show());
    for (const signal of [modelling.changed, modelling.selectionChanged, angles.changed]) signal.on(tree.refresh);
    this.show();
  }

  private show(): void {
    const { active, file, unsaved, entities } = this.modelling;
    this.inactiveView.hidden = active;
    this.activeView.hidden = !active;
    this.file.textContent = file === null ? strings.modelling.untitled : shortPath(file);
    this.file.title = file ?? "";
    this.mark.hidden = !unsaved;
    this.empty.hidden = entities.length > 0;
    for (const [made, possible] of this.actions) made.disabled = !possible();
  }

  private grid(angles: AngleUnits): HTMLElement {
    const words = strings.modelling;
    const { snapping } = this.modelling;
    const steps = (values: readonly number[], unit: string): (readonly [string, string])[] => values.map((value) => [String(value), `${value}${unit}`]);
    const length = choice(words.lengthStep, steps(LENGTH_STEPS, " m"), (value) => (snapping.metres = Number(value)));
    const angle = choice(words.angleStep, steps(ANGLE_STEPS, "°"), (value) => (snapping.degrees = Number(value)));
    const show = (): void => {
      length.value = String(snapping.metres);
      angle.value = String(snapping.degrees);
    };
    snapping.changed.on(show);
    show();
    return h("div", { class: "world-grid" }, icon("magnet"), length, angle, h("span", { class: "spacer" }), new UnitSwitch(angles).element);
  }
}

function action(label: string, keys: Shortcut, name: IconName, run: () => void): HTMLButtonElement {
  return button(`${label} (${keyText(keys)})`, run, "tool bare", icon(name));
}

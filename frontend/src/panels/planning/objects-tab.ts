import { createButton, h } from "../../dom";
import type { MotionPlanningState, ObjectShape, PlanningObject } from "../../protocol";
import type { AngleUnits } from "../../state/angle-unit";
import type { MotionPlanning } from "../../state/motion-planning";
import { strings } from "../../strings";
import { formatFixed, parseNumber } from "../../tree/numbers";
import { createSelect } from "../../widgets/controls";
import { UnitSwitch } from "../../widgets/unit-switch";
import { onVisibilityChange } from "../../widgets/visibility";
import { ChoiceSetting } from "./setting-fields";
import type { Tab } from "./tab";

const SHAPES: readonly ObjectShape[] = ["box", "sphere", "cylinder", "cone"];
/** The sizes of a new object, m. */
const DEFAULT_SIZES: Readonly<Record<ObjectShape, readonly number[]>> = {
  box: [0.1, 0.1, 0.1],
  sphere: [0.05],
  cylinder: [0.1, 0.05],
  cone: [0.1, 0.05],
};
const POSE_NAMES = ["X", "Y", "Z", "Roll", "Pitch", "Yaw"] as const;
const ROW_COUNT = 5;

/** The tab "Scene Objects": the objects of the planning scene, which are added, moved, attached and removed. */
export class ObjectsTab implements Tab {
  readonly element: HTMLElement;
  private readonly shape: HTMLSelectElement;
  private readonly nameField = h("input", { class: "field", aria: { label: strings.motionPlanning.objects.name } });
  private readonly sizes = h("div", { class: "planning-grid" });
  private readonly list: HTMLSelectElement;
  private readonly emptyNote = h("p", { class: "note" }, strings.motionPlanning.objects.none);
  private readonly poseTitle = h("span", { class: "toolbar-label pose-title" });
  private readonly poseFields: readonly HTMLInputElement[];
  private readonly link: ChoiceSetting;
  private readonly selectedBox: HTMLElement;
  private readonly attachButton: HTMLButtonElement;
  private readonly detachButton: HTMLButtonElement;
  private readonly problem = h("p", { class: "note wrong", role: "status" });
  private selectedName = "";
  /** The object that has a handle in the scene. */
  private handledName = "";
  private isVisible = false;
  private shownObjects = "";
  private chosenLink = "";
  private state: MotionPlanningState | null = null;

  constructor(
    private readonly planning: MotionPlanning,
    private readonly angles: AngleUnits,
  ) {
    const texts = strings.motionPlanning.objects;
    this.shape = createSelect<ObjectShape>(texts.shape, SHAPES.map((shape) => [shape, texts.shapes[shape]] as const), () => this.showSizes());
    this.list = createSelect<string>(texts.list, [], (name) => this.select(name));
    this.list.size = ROW_COUNT;
    this.list.classList.add("planning-objects");
    this.poseFields = POSE_NAMES.map((name) => this.createPoseField(name));
    this.link = new ChoiceSetting(texts.link, (link) => (this.chosenLink = link));
    const attach = (link: string): void => planning.send({ type: "attach_scene_object", name: this.selectedName, link });
    this.attachButton = createButton(texts.attachHint, () => attach(this.link.value), "tool framed", texts.attach);
    this.detachButton = createButton(texts.detachHint, () => attach(""), "tool framed", texts.detach);
    const removeButton = createButton(texts.removeHint, () => planning.send({ type: "remove_scene_object", name: this.selectedName }), "tool framed", texts.remove);
    this.selectedBox = h(
      "div",
      {},
      h("div", { class: "planning-row" }, this.poseTitle, h("span", { class: "spacer" }), new UnitSwitch(angles).element),
      h("div", { class: "planning-grid" }, ...this.poseFields.map((field, i) => h("label", {}, POSE_NAMES[i] ?? "", field))),
      this.link.element,
      h("div", { class: "planning-commands" }, this.attachButton, this.detachButton, removeButton),
    );
    const addButton = createButton(texts.addHint, () => this.add(), "tool framed primary", texts.add);
    this.element = h(
      "div",
      { class: "scroll planning-tab" },
      h("div", { class: "planning-row" }, h("span", { class: "toolbar-label" }, texts.shape), this.shape),
      h("div", { class: "planning-row" }, h("span", { class: "toolbar-label" }, texts.name), this.nameField),
      this.sizes,
      h("div", { class: "planning-commands" }, addButton),
      this.problem,
      this.list,
      this.emptyNote,
      this.selectedBox,
    );
    angles.changed.on(() => this.showSelected());
    onVisibilityChange(this.element, (isVisible) => {
      this.isVisible = isVisible;
      this.requestHandle();
    });
    this.showSizes();
  }

  show(state: MotionPlanningState): void {
    const texts = strings.motionPlanning.objects;
    this.state = state;
    const names = state.objects.map(({ name, link }) => (link === "" ? name : texts.attachedTo(name, link)));
    const key = JSON.stringify(state.objects.map(({ name, link }) => [name, link]));
    if (key !== this.shownObjects) {
      this.shownObjects = key;
      this.list.replaceChildren(...state.objects.map(({ name }, i) => new Option(names[i], name)));
      if (this.nameField.value === "" || this.hasObject(this.nameField.value)) this.nameField.value = this.proposeName();
    }
    if (!this.hasObject(this.selectedName)) this.selectedName = state.objects[0]?.name ?? this.selectedName;
    this.list.value = this.selectedName;
    this.list.hidden = state.objects.length === 0;
    this.emptyNote.hidden = state.objects.length > 0;
    this.problem.textContent = state.refused ? texts.refused : "";
    this.showSelected();
  }

  private get selected(): PlanningObject | undefined {
    return this.state?.objects.find(({ name }) => name === this.selectedName);
  }

  private hasObject(name: string): boolean {
    return this.state?.objects.some((object) => object.name === name) === true;
  }

  private select(name: string): void {
    this.selectedName = name;
    this.showSelected();
  }

  private add(): void {
    const shape = this.shape.value as ObjectShape;
    const name = this.nameField.value.trim() || this.proposeName();
    const size = [...this.sizes.querySelectorAll("input")].map((field) => parseNumber(field.value) ?? 0);
    if (!size.every((value) => value > 0)) return;
    this.planning.send({ type: "add_scene_object", name, shape, size });
    this.selectedName = name;
  }

  /** Returns a name that no object has, such as `box_2`. */
  private proposeName(): string {
    const { value: shape } = this.shape;
    let number = 1;
    while (this.hasObject(`${shape}_${number}`)) number += 1;
    return `${shape}_${number}`;
  }

  private showSizes(): void {
    const texts = strings.motionPlanning.objects;
    const shape = this.shape.value as ObjectShape;
    const fields = texts.sizes[shape].map((name, i) => {
      const field = h("input", { class: "field numeric", aria: { label: texts.sizeLabel(name) } });
      field.inputMode = "decimal";
      field.value = String(DEFAULT_SIZES[shape][i] ?? 0.1);
      return h("label", {}, `${name} (m)`, field);
    });
    this.sizes.replaceChildren(...fields);
    this.nameField.value = this.proposeName();
  }

  private createPoseField(name: string): HTMLInputElement {
    const field = h("input", { class: "field numeric", aria: { label: strings.motionPlanning.objects.poseLabel(name) } });
    field.inputMode = "decimal";
    field.addEventListener("change", () => this.move());
    return field;
  }

  private get angleScale(): number {
    return this.angles.scaleOf("revolute");
  }

  private move(): void {
    const numbers = this.poseFields.map((field, i) => (parseNumber(field.value) ?? NaN) / (i < 3 ? 1 : this.angleScale));
    if (numbers.every(Number.isFinite)) {
      this.planning.send({ type: "move_scene_object", name: this.selectedName, position: numbers.slice(0, 3), rpy: numbers.slice(3) });
    } else this.showSelected();
  }

  /** Gives the selected object a handle in the scene, while the tab is visible. An attached object moves with its link. */
  private requestHandle(): void {
    const { selected } = this;
    const name = this.isVisible && selected?.link === "" ? selected.name : "";
    if (name === this.handledName) return;
    this.handledName = name;
    this.planning.send({ type: "select_scene_object", name });
  }

  private showSelected(): void {
    const { selected } = this;
    this.requestHandle();
    this.selectedBox.hidden = selected === undefined;
    if (!selected || !this.state) return;
    const isAttached = selected.link !== "";
    this.poseTitle.textContent = strings.motionPlanning.objects.frame(selected.frame);
    [...selected.position, ...selected.rpy].forEach((value, i) => {
      const field = this.poseFields[i];
      if (!field) return;
      field.disabled = isAttached;
      if (document.activeElement !== field) field.value = formatFixed(i < 3 ? value : value * this.angleScale, i < 3 || this.angleScale === 1 ? 3 : 1);
    });
    const link = isAttached ? selected.link : this.state.links.includes(this.chosenLink) ? this.chosenLink : (this.state.links[0] ?? "");
    this.link.show(link, this.state.links.map((name) => [name, name] as const));
    this.attachButton.disabled = isAttached;
    this.detachButton.disabled = !isAttached;
  }
}

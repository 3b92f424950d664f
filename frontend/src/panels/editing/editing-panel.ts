import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { EditablePart } from "../../protocol";
import type { HandleFrame } from "../../state/editing/editing";
import { ANGLE_STEPS_DEG } from "../../state/modeling/snapping";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { formatNumber, parseNumber } from "../../tree/numbers";
import { createSelect } from "../../widgets/controls";
import { UnitSwitch } from "../../widgets/unit-switch";
import { holdWhileVisible } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { shortenPath } from "../place";
import { EditOutcome } from "./edit-outcome";

/** The lengths to choose from for the grid, m. */
const LENGTH_STEPS_M = [0.001, 0.005, 0.01, 0.05, 0.1] as const;
/** The steps of an arrow key: m or a component of an axis; rad where angles are shown in rad, and in degrees. */
const [LENGTH_KEY_STEP, RADIAN_KEY_STEP, DEGREE_KEY_STEP] = [0.001, 0.01, Math.PI / 180];

/** A number field; `isTyped` while the user has not finished typing. */
interface NumberInput {
  readonly input: HTMLInputElement;
  readonly getValue: () => number;
  isTyped: boolean;
}

/** Moves and turns the parts of the selected link, and shows the resulting change of the files. */
export class EditingPanel implements Panel {
  readonly id = "editing";
  readonly icon = "handles";
  readonly element: HTMLElement;
  private readonly hint = h("p", { class: "hint editing-hint" });
  private readonly workArea = h("div", { class: "editing-work" });
  private readonly list = h("div", { class: "editing-parts", role: "group", aria: { label: strings.editing.parts } });
  private readonly placeBox = h("div", { class: "editing-place" });
  private readonly fields = h("div", { class: "editing-fields" });
  private readonly modes = h("div", { class: "segmented", role: "group", aria: { label: strings.editing.handles } });
  private shownPart: EditablePart | null = null;
  /** The part and unit for which the fields were built. */
  private builtKey = "";
  private inputs: NumberInput[] = [];
  /** The controls that only a pose needs: an axis can only be rotated in its joint's frame. */
  private poseControls: readonly HTMLElement[] = [];

  constructor(private readonly session: Session) {
    const { editing, focus, angleUnits } = session;
    const numbers = h("div", { class: "editing-numbers" }, this.placeBox, this.fields, this.createTools());
    this.workArea.append(numbers, new EditOutcome(editing).element);
    this.element = h("div", { class: "panel editing-panel" }, h("div", { class: "editing-body" }, this.hint, this.list, this.workArea));
    const update = coalesce(() => this.update());
    const followFocus = (): void => {
      const { current } = focus;
      const link = current && focus.linkOf(current);
      editing.setLink(current && typeof link === "string" ? { display: current.display, link } : null);
    };
    holdWhileVisible(this.element, () => editing.activate(), update);
    focus.changed.on(followFocus);
    for (const signal of [editing.changed, editing.draftChanged, editing.snapping.changed]) signal.on(update);
    angleUnits.changed.on(() => {
      this.shownPart = null;
      this.update(); // Update immediately: the next number typed is in the new unit.
    });
    followFocus();
    this.update();
  }

  private update(): void {
    const { editing } = this.session;
    const texts = strings.editing;
    const { chosenPart, parts, unavailableReason, current } = editing;
    const reason = current === null ? texts.selectLink : unavailableReason !== "" ? unavailableReason : "";
    this.hint.hidden = reason === "";
    this.hint.textContent = reason;
    this.workArea.hidden = this.list.hidden = current === null || parts.length === 0;
    this.list.replaceChildren(...parts.map((part) => this.createPartRow(part)));
    if (chosenPart !== this.shownPart) this.buildFields(chosenPart);
    for (const { input, getValue, isTyped } of this.inputs) {
      input.disabled = unavailableReason !== "";
      if (!isTyped) input.value = formatNumber(getValue());
    }
    for (const control of this.poseControls) control.hidden = chosenPart?.part === "axis";
    this.showModes();
  }

  private createPartRow(part: EditablePart): HTMLElement {
    const texts = strings.editing;
    const { editing } = this.session;
    const isChosen = part === editing.chosenPart;
    const kind = texts.kinds[part.part];
    const title = part.part === "joint" || part.part === "axis" ? part.name : part.title;
    const row = createButton(texts.choose(kind, part.title), () => editing.choosePart(part), "editing-part", h("strong", {}, kind), " ", h("span", {}, title));
    row.setAttribute("aria-pressed", String(isChosen));
    row.classList.toggle("selected", isChosen);
    return row;
  }

  /** Builds the fields of a part, or keeps them if it is the same part: the user may be typing. */
  private buildFields(part: EditablePart | null): void {
    this.shownPart = part;
    this.placeBox.replaceChildren();
    if (part) this.showPlace(part);
    const key = part ? [part.part, part.name, part.index, this.session.angleUnits.current].join(" ") : "";
    if (key === this.builtKey) return;
    this.builtKey = key;
    this.inputs = [];
    this.fields.replaceChildren(...(part ? this.createRows(part) : []));
  }

  private showPlace(part: EditablePart): void {
    const texts = strings.editing;
    const { file, line, written } = part;
    if (file !== "") {
      const show = (): void => this.session.description.placeRequested.emit({ file, line });
      const text = `${shortenPath(file)}:${line}`;
      const placeButton = createButton(`${file}:${line}`, show, "place", createIcon("file"), text);
      this.placeBox.append(placeButton, h("code", { title: written }, written === "" ? texts.notWritten : written));
    }
  }

  private createRows(part: EditablePart): HTMLElement[] {
    const texts = strings.editing;
    if (part.part === "axis") return [this.createRow(texts.axis, "xyz", ["x", "y", "z"], "")];
    const isInDegrees = this.session.angleUnits.current === "deg";
    return [
      this.createRow(texts.position, "xyz", ["x", "y", "z"], "m"),
      this.createRow(texts.rotation, "rpy", texts.angles, isInDegrees ? strings.joints.degrees : strings.joints.radians),
    ];
  }

  private createRow(label: string, kind: "xyz" | "rpy", names: readonly string[], unit: string): HTMLElement {
    const cells = names.map((name, i) => {
      const input = h("input", { class: "field numeric", aria: { label: `${label} ${name}` }, data: { number: `${kind}${i}` } });
      input.type = "text";
      input.inputMode = "decimal";
      const getValue = (): number => this.getValue(kind, i) * this.scaleOf(kind);
      const numberInput: NumberInput = { input, getValue, isTyped: false };
      this.inputs.push(numberInput);
      this.bindInput(numberInput, kind, i);
      return h("label", { class: "editing-number" }, h("span", {}, name), input);
    });
    return h("div", { class: "editing-row" }, h("span", { class: "editing-label" }, label), ...cells, h("span", { class: "unit" }, unit));
  }

  private bindInput(numberInput: NumberInput, kind: "xyz" | "rpy", index: number): void {
    const { input, getValue } = numberInput;
    const show = (): void => {
      numberInput.isTyped = false;
      input.value = formatNumber(getValue());
    };
    const apply = (): void => {
      const number = parseNumber(input.value);
      if (numberInput.isTyped && number !== null && input.value !== formatNumber(getValue())) this.setValue(kind, index, number / this.scaleOf(kind));
      show();
    };
    const step = (direction: number): void => {
      const angle = this.session.angleUnits.current === "deg" ? DEGREE_KEY_STEP : RADIAN_KEY_STEP;
      this.setValue(kind, index, this.getValue(kind, index) + direction * (kind === "rpy" ? angle : LENGTH_KEY_STEP));
      show();
    };
    input.addEventListener("input", () => (numberInput.isTyped = true));
    input.addEventListener("focus", () => input.select());
    input.addEventListener("blur", apply);
    input.addEventListener("keydown", (event) => {
      if (event.key === "Enter") apply();
      else if (event.key === "Escape") show();
      else if (event.key === "ArrowUp") step(1);
      else if (event.key === "ArrowDown") step(-1);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }

  private getValue(kind: "xyz" | "rpy", index: number): number {
    const { draft, chosenPart } = this.session.editing;
    return (draft ?? chosenPart)?.[kind][index] ?? 0;
  }

  private setValue(kind: "xyz" | "rpy", index: number, value: number): void {
    const { editing } = this.session;
    const pose = editing.draft ?? editing.chosenPart;
    if (!pose) return;
    // Converting typed degrees must not add digits to the file.
    const roundedValue = Number(value.toPrecision(12));
    editing.setDraft({ xyz: pose.xyz, rpy: pose.rpy, [kind]: pose[kind].map((component, i) => (i === index ? roundedValue : component)) });
  }

  private scaleOf(kind: "xyz" | "rpy"): number {
    return kind === "rpy" ? this.session.angleUnits.scaleOf("revolute") : 1;
  }

  private createTools(): HTMLElement {
    const texts = strings.editing;
    const { editing, angleUnits } = this.session;
    const frameSelect = createSelect<HandleFrame>(texts.frameHint, [["parent", texts.parentFrame], ["own", texts.ownFrame]], (value) => (editing.frame = value));
    const createStepOptions = (values: readonly number[], unit: string): (readonly [string, string])[] => values.map((value) => [String(value), `${value}${unit}`]);
    const { snapping } = editing;
    const lengthSelect = createSelect(strings.modeling.lengthStep, createStepOptions(LENGTH_STEPS_M, " m"), (value) => (snapping.meters = Number(value)));
    const angleSelect = createSelect(strings.modeling.angleStep, createStepOptions(ANGLE_STEPS_DEG, "°"), (value) => (snapping.degrees = Number(value)));
    const snapButton = createButton(texts.snap, () => (snapping.isEnabled = !snapping.isEnabled), "tool bare", createIcon("magnet"));
    const show = (): void => {
      snapButton.setAttribute("aria-pressed", String(snapping.isEnabled));
      snapButton.classList.toggle("active", snapping.isEnabled);
      lengthSelect.value = String(snapping.meters);
      angleSelect.value = String(snapping.degrees);
      frameSelect.value = editing.frame;
    };
    snapping.changed.on(show);
    show();
    this.poseControls = [this.modes, frameSelect, lengthSelect];
    return h("div", { class: "editing-tools" }, this.modes, frameSelect, snapButton, lengthSelect, angleSelect, h("span", { class: "spacer" }), new UnitSwitch(angleUnits).element);
  }

  private showModes(): void {
    const { editing } = this.session;
    const texts = strings.editing;
    const createModeButton = (mode: "translate" | "rotate"): HTMLElement => {
      const modeButton = createButton(texts.modeHints[mode], () => (editing.mode = mode), editing.mode === mode ? "on" : "", texts.modes[mode]);
      modeButton.setAttribute("aria-pressed", String(editing.mode === mode));
      return modeButton;
    };
    this.modes.replaceChildren(createModeButton("translate"), createModeButton("rotate"));
  }
}

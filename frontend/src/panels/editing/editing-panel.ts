import { button, coalesced, h } from "../../dom";
import { icon } from "../../icons";
import type { EditablePart } from "../../protocol";
import type { HandleFrame } from "../../state/editing/editing";
import { ANGLE_STEPS } from "../../state/modeling/snapping";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { formatNumber, parseNumber } from "../../tree/numbers";
import { choice } from "../../widgets/controls";
import { UnitSwitch } from "../../widgets/unit-switch";
import { holdWhileVisible } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { shortenPath } from "../place";
import { EditOutcome } from "./edit-outcome";

/** m */
const LENGTH_STEPS_M = [0.001, 0.005, 0.01, 0.05, 0.1] as const;
/** The step of an arrow key: m, components of an axis, rad. */
const [MOVE, TURN_RAD, TURN_DEGREES] = [0.001, 0.01, Math.PI / 180];

/** A number field; `isTyped` while the user has not finished typing. */
interface NumberInput {
  readonly input: HTMLInputElement;
  readonly value: () => number;
  isTyped: boolean;
}

/** Moves and turns the parts of the selected link, and shows the resulting change of the files. */
export class EditingPanel implements Panel {
  readonly id = "editing";
  readonly icon = "handles";
  readonly element: HTMLElement;
  private readonly hint = h("p", { class: "hint editing-hint" });
  private readonly work = h("div", { class: "editing-work" });
  private readonly list = h("div", { class: "editing-parts", role: "group", aria: { label: strings.editing.parts } });
  private readonly place = h("div", { class: "editing-place" });
  private readonly fields = h("div", { class: "editing-fields" });
  private readonly modes = h("div", { class: "segmented", role: "group", aria: { label: strings.editing.handles } });
  private shown: EditablePart | null = null;
  /** The part and unit for which the fields were built. */
  private builtKey = "";
  private inputs: NumberInput[] = [];
  /** The controls that only a pose needs: an axis can only be rotated in its joint's frame. */
  private poseControls: readonly HTMLElement[] = [];

  constructor(private readonly session: Session) {
    const { editing, focus, angles } = session;
    const numbers = h("div", { class: "editing-numbers" }, this.place, this.fields, this.tools());
    this.work.append(numbers, new EditOutcome(editing).element);
    this.element = h("div", { class: "panel editing-panel" }, h("div", { class: "editing-body" }, this.hint, this.list, this.work));
    const update = coalesced(() => this.update());
    const follow = (): void => {
      const { current } = focus;
      const link = current && focus.linkOf(current);
      editing.follow(current && typeof link === "string" ? { display: current.display, link } : null);
    };
    holdWhileVisible(this.element, () => editing.hold(), update);
    focus.changed.on(follow);
    for (const signal of [editing.changed, editing.draftChanged, editing.snapping.changed]) signal.on(update);
    angles.changed.on(() => {
      this.shown = null;
      this.update(); // Update immediately: the number typed next is meant in the new unit.
    });
    follow();
    this.update();
  }

  private update(): void {
    const { editing } = this.session;
    const texts = strings.editing;
    const { chosenPart, parts, unavailableReason: refusal, current } = editing;
    const why = current === null ? texts.selectLink : refusal !== "" ? refusal : "";
    this.hint.hidden = why === "";
    this.hint.textContent = why;
    this.work.hidden = this.list.hidden = current === null || parts.length === 0;
    this.list.replaceChildren(...parts.map((part) => this.partRow(part)));
    if (chosenPart !== this.shown) this.build(chosenPart);
    for (const { input, value, isTyped } of this.inputs) {
      input.disabled = refusal !== "";
      if (!isTyped) input.value = formatNumber(value());
    }
    for (const control of this.poseControls) control.hidden = chosenPart?.part === "axis";
    this.showModes();
  }

  private partRow(part: EditablePart): HTMLElement {
    const texts = strings.editing;
    const { editing } = this.session;
    const isChosen = part === editing.chosenPart;
    const what = texts.kinds[part.part];
    const row = button(texts.choose(what, part.title), () => editing.choose(part), "editing-part", h("strong", {}, what), " ", h("span", {}, part.part === "joint" || part.part === "axis" ? part.name : part.title));
    row.setAttribute("aria-pressed", String(isChosen));
    row.classList.toggle("selected", isChosen);
    return row;
  }

  /** Builds the fields of a part, or keeps them if it is the same part: the user may be typing. */
  private build(part: EditablePart | null): void {
    this.shown = part;
    this.place.replaceChildren();
    if (part) this.showPlace(part);
    const built = part ? [part.part, part.name, part.index, this.session.angles.current].join(" ") : "";
    if (built === this.builtKey) return;
    this.builtKey = built;
    this.inputs = [];
    this.fields.replaceChildren(...(part ? this.rows(part) : []));
  }

  private showPlace(part: EditablePart): void {
    const texts = strings.editing;
    const { file, line, written } = part;
    if (file !== "") {
      const show = (): void => this.session.description.placeRequested.emit({ file, line });
      const text = `${shortenPath(file)}:${line}`;
      this.place.append(button(`${file}:${line}`, show, "place", icon("file"), text), h("code", { title: written }, written === "" ? texts.notWritten : written));
    }
  }

  private rows(part: EditablePart): HTMLElement[] {
    const texts = strings.editing;
    if (part.part === "axis") return [this.row(texts.axis, "xyz", ["x", "y", "z"], "")];
    const degrees = this.session.angles.current === "deg";
    return [
      this.row(texts.position, "xyz", ["x", "y", "z"], "m"),
      this.row(texts.rotation, "rpy", texts.angles, degrees ? strings.joints.degrees : strings.joints.radians),
    ];
  }

  private row(label: string, kind: "xyz" | "rpy", names: readonly string[], unit: string): HTMLElement {
    const cells = names.map((name, i) => {
      const input = h("input", { class: "field numeric", aria: { label: `${label} ${name}` }, data: { number: `${kind}${i}` } });
      input.type = "text";
      input.inputMode = "decimal";
      const value = (): number => this.currentValue(kind, i) * this.scale(kind);
      const made: NumberInput = { input, value, isTyped: false };
      this.inputs.push(made);
      this.bindInput(made, kind, i);
      return h("label", { class: "editing-number" }, h("span", {}, name), input);
    });
    return h("div", { class: "editing-row" }, h("span", { class: "editing-label" }, label), ...cells, h("span", { class: "unit" }, unit));
  }

  private bindInput(made: NumberInput, kind: "xyz" | "rpy", index: number): void {
    const { input, value } = made;
    const show = (): void => {
      made.isTyped = false;
      input.value = formatNumber(value());
    };
    const read = (): void => {
      const number = parseNumber(input.value);
      if (made.isTyped && number !== null && input.value !== formatNumber(value())) this.set(kind, index, number / this.scale(kind));
      show();
    };
    const step = (by: number): void => {
      const angle = this.session.angles.current === "deg" ? TURN_DEGREES : TURN_RAD;
      this.set(kind, index, this.currentValue(kind, index) + by * (kind === "rpy" ? angle : MOVE));
      show();
    };
    input.addEventListener("input", () => (made.isTyped = true));
    input.addEventListener("focus", () => input.select());
    input.addEventListener("blur", read);
    input.addEventListener("keydown", (event) => {
      if (event.key === "Enter") read();
      else if (event.key === "Escape") show();
      else if (event.key === "ArrowUp") step(1);
      else if (event.key === "ArrowDown") step(-1);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }

  private currentValue(kind: "xyz" | "rpy", index: number): number {
    const { draft, chosenPart } = this.session.editing;
    return (draft ?? chosenPart)?.[kind][index] ?? 0;
  }

  private set(kind: "xyz" | "rpy", index: number, value: number): void {
    const { editing } = this.session;
    const now = editing.draft ?? editing.chosenPart;
    if (!now) return;
    // Converting typed degrees must not add digits to the file.
    const rounded = Number(value.toPrecision(12));
    editing.move({ xyz: now.xyz, rpy: now.rpy, [kind]: now[kind].map((old, i) => (i === index ? rounded : old)) });
  }

  private scale(kind: "xyz" | "rpy"): number {
    return kind === "rpy" ? this.session.angles.scale("revolute") : 1;
  }

  private tools(): HTMLElement {
    const texts = strings.editing;
    const { editing, angles } = this.session;
    const frame = choice<HandleFrame>(texts.frameHint, [["parent", texts.parentFrame], ["own", texts.ownFrame]], (value) => (editing.frame = value));
    const steps = (values: readonly number[], unit: string): (readonly [string, string])[] => values.map((value) => [String(value), `${value}${unit}`]);
    const { snapping } = editing;
    const length = choice(strings.modeling.lengthStep, steps(LENGTH_STEPS_M, " m"), (value) => (snapping.meters = Number(value)));
    const angle = choice(strings.modeling.angleStep, steps(ANGLE_STEPS, "°"), (value) => (snapping.degrees = Number(value)));
    const snap = button(texts.snap, () => (snapping.isEnabled = !snapping.isEnabled), "tool bare", icon("magnet"));
    const show = (): void => {
      snap.setAttribute("aria-pressed", String(snapping.isEnabled));
      snap.classList.toggle("active", snapping.isEnabled);
      length.value = String(snapping.meters);
      angle.value = String(snapping.degrees);
      frame.value = editing.frame;
    };
    snapping.changed.on(show);
    show();
    this.poseControls = [this.modes, frame, length];
    return h("div", { class: "editing-tools" }, this.modes, frame, snap, length, angle, h("span", { class: "spacer" }), new UnitSwitch(angles).element);
  }

  private showModes(): void {
    const { editing } = this.session;
    const texts = strings.editing;
    const make = (mode: "translate" | "rotate"): HTMLElement => {
      const made = button(texts.modeHints[mode], () => (editing.mode = mode), editing.mode === mode ? "on" : "", texts.modes[mode]);
      made.setAttribute("aria-pressed", String(editing.mode === mode));
      return made;
    };
    this.modes.replaceChildren(make("translate"), make("rotate"));
  }
}

import { h } from "../../dom";
import { createIcon } from "../../icons";
import type { JointControl } from "../../protocol";
import type { AngleUnits } from "../../state/angle-unit";
import { formatMimic } from "../../state/joint-table";
import { strings } from "../../strings";
import { clamp, formatFixed, parseNumber } from "../../tree/numbers";

/** ms for which positions from the server do not move the slider after the user moved it. */
const IGNORE_SERVER_MS = 250;

/**
 * The number of characters at the end of a name that remain visible in a narrow panel: names of related joints often
 * have the same beginning, and end in `_joint`.
 */
const VISIBLE_END_LENGTH = 14;
/** The maximum length of names that are never cut. */
const UNCUT_LENGTH = 10;

/** Splits a name into a part that may be cut, and its end, which always remains visible. */
export function splitName(name: string): readonly [string, string] {
  const cutLength = name.length > UNCUT_LENGTH ? name.length - Math.min(VISIBLE_END_LENGTH, Math.floor(name.length / 2)) : name.length;
  return [name.slice(0, cutLength), name.slice(cutLength)];
}

/** A joint in the Joints panel: name, number field, slider and limits. */
export class JointRow {
  readonly element: HTMLElement;
  private readonly slider = h("input", { class: "slider" });
  private readonly field = h("input", { class: "field numeric" });
  private readonly unit = h("span", { class: "unit" });
  private readonly limits = [h("span"), h("span")] as const;
  private readonly relation = h("span");
  private position = 0;
  private lastMovedMs = -Infinity;
  private isDragging = false;

  constructor(
    readonly joint: JointControl,
    private readonly angles: AngleUnits,
    private readonly onMoved: (position: number) => void,
  ) {
    const isFollower = joint.mimic !== null;
    const nameParts = splitName(joint.name).map((part) => h("span", {}, part));
    // Screen readers get the whole name from the slider and the field.
    const name = h("span", { class: "joint-name", title: joint.name, aria: { hidden: "true" } }, ...nameParts);
    const mimicElement = isFollower
      ? h("div", { class: "mimic", title: strings.joints.follows(joint.mimic ?? "") }, createIcon("link"), this.relation)
      : null;
    this.slider.type = "range";
    this.slider.min = String(joint.lower);
    this.slider.max = String(joint.upper);
    this.slider.step = "any";
    this.field.type = "text";
    this.field.inputMode = "decimal";
    this.slider.disabled = this.field.disabled = isFollower;
    this.slider.setAttribute("aria-label", joint.name);
    this.field.setAttribute("aria-label", strings.joints.position(joint.name));
    this.bindInputs();
    this.element = h(
      "div",
      { class: isFollower ? "joint follower" : "joint", data: { joint: joint.name } },
      h("div", { class: "joint-head" }, name, h("span", { class: "spacer" }), this.field, this.unit),
      h("div", { class: "joint-slide" }, this.limits[0], this.slider, this.limits[1]),
      mimicElement,
    );
    this.showUnit();
  }

  /** Shows the current unit of angles. */
  showUnit(): void {
    const { lower, upper } = this.joint;
    this.unit.textContent = this.unitName;
    this.limits[0].textContent = `${this.format(lower)} ${this.unitName}`;
    this.limits[1].textContent = `${this.format(upper)} ${this.unitName}`;
    this.relation.textContent = this.relationText;
    this.show();
  }

  /** Shows a position from the server, except while the user is moving the joint. */
  setPosition(position: number): void {
    if (this.isDragging || performance.now() - this.lastMovedMs < IGNORE_SERVER_MS) return;
    this.position = position;
    this.show();
  }

  private bindInputs(): void {
    this.slider.addEventListener("input", () => this.move(Number(this.slider.value)));
    this.slider.addEventListener("pointerdown", () => (this.isDragging = true));
    for (const eventType of ["pointerup", "pointercancel", "blur"]) {
      this.slider.addEventListener(eventType, () => (this.isDragging = false));
    }
    this.field.addEventListener("focus", () => this.field.select());
    this.field.addEventListener("blur", () => this.applyField());
    this.field.addEventListener("keydown", (event) => {
      if (event.key === "Enter") this.applyField();
      else if (event.key === "Escape") this.show(true);
      else if (event.key === "ArrowUp") this.move(this.position + this.step);
      else if (event.key === "ArrowDown") this.move(this.position - this.step);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }

  private applyField(): void {
    if (this.field.value === this.format(this.position)) return;
    const value = parseNumber(this.field.value);
    if (value === null) this.show(true);
    else this.move(value / this.scale);
  }

  private move(position: number): void {
    this.lastMovedMs = performance.now();
    this.position = clamp(position, this.joint.lower, this.joint.upper);
    this.show(true);
    this.onMoved(this.position);
  }

  private show(replacesTypedText = false): void {
    const { lower, upper } = this.joint;
    const fraction = upper > lower ? (this.position - lower) / (upper - lower) : 0;
    if (!this.isDragging) this.slider.value = String(this.position);
    this.slider.style.setProperty("--part", String(clamp(fraction, 0, 1)));
    const zeroFraction = upper > lower ? (this.joint.zero - lower) / (upper - lower) : 0;
    this.slider.style.setProperty("--zero", String(clamp(zeroFraction, 0, 1)));
    this.slider.setAttribute("aria-valuetext", `${this.format(this.position)} ${this.unit.textContent}`);
    if (replacesTypedText || document.activeElement !== this.field) this.field.value = this.format(this.position);
  }

  private get scale(): number {
    return this.angles.scaleOf(this.joint.kind);
  }

  private get unitName(): string {
    const texts = strings.joints;
    if (this.joint.kind === "prismatic") return texts.meters;
    return this.angles.current === "deg" ? texts.degrees : texts.radians;
  }

  /** The relation of a mimic joint to its leading joint: `2 × elbow + 0.1 rad`. */
  private get relationText(): string {
    const { mimic, multiplier, offset } = this.joint;
    return mimic === null ? "" : formatMimic(mimic, multiplier, offset * this.scale, this.unitName);
  }

  /** The step of an arrow key in the number field: 1 degree, 0.01 rad or 1 mm. */
  private get step(): number {
    if (this.joint.kind === "prismatic") return 0.001;
    return this.angles.current === "deg" ? Math.PI / 180 : 0.01;
  }

  private format(position: number): string {
    return formatFixed(position * this.scale, this.scale !== 1 ? 1 : 3);
  }
}

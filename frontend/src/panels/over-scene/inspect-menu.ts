import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { InspectedProperties } from "../../state/inspect";
import { formatGeneral } from "../../state/number-text";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { closeOnOutsideClick } from "../../widgets/popover";
import { getCurrentModel } from "../description/current-model";

const PROPERTIES = ["centers", "boxes", "ellipsoids", "joints", "contrast", "frames"] as const;
/** The ends of the slider are powers of two: a quarter of the size, and four times the size. */
const MAX_SCALE_EXPONENT = 2;

/** The menu over the scene that shows invisible properties, and the findings on them. */
export class InspectMenu {
  readonly element = h("div", { class: "inspect" });
  private readonly card = h("div", { class: "inspect-card", role: "group", aria: { label: strings.description.inspect.button } });
  private readonly facts = h("div", { class: "inspect-facts" });
  private readonly checkBoxes = new Map<keyof InspectedProperties, HTMLInputElement>();
  private readonly depthSlider = h("input", { class: "slider" });
  private readonly depthText = h("output");
  private readonly scaleSlider = h("input", { class: "slider" });
  private readonly openButton: HTMLButtonElement;
  private release: () => void = () => undefined;

  /** @param onResized - called when the menu covers a different part of the scene. */
  constructor(
    private readonly session: Session,
    private readonly onResized: () => void,
  ) {
    const texts = strings.description.inspect;
    this.openButton = createButton(texts.hint, () => this.toggle(this.card.hidden !== false), "tool", createIcon("inspect"), texts.button);
    this.card.append(...PROPERTIES.map((choice) => this.createPropertyBox(choice)), this.createDepthRow(), this.createScaleRow(), this.facts);
    this.element.append(this.openButton, this.card);
    const { inspect, description, robotChanged } = session;
    const show = coalesce(() => this.show());
    inspect.changed.on(show);
    description.arrived.on(show);
    description.findingsArrived.on(show);
    robotChanged.on(show);
    this.toggle(false);
    this.show();
  }

  private toggle(isOpen: boolean): void {
    this.release();
    this.release = isOpen ? closeOnOutsideClick([this.element], (returnsFocus) => this.onClosed(returnsFocus)) : () => undefined;
    this.card.hidden = !isOpen;
    this.openButton.setAttribute("aria-expanded", String(isOpen));
    this.onResized();
  }

  private onClosed(returnsFocus: boolean): void {
    this.toggle(false);
    if (returnsFocus) this.openButton.focus();
  }

  private createPropertyBox(property: keyof InspectedProperties): HTMLElement {
    const texts = strings.description.inspect;
    const box = h("input", { class: "check" });
    box.type = "checkbox";
    box.addEventListener("change", () => this.session.inspect.set(property, box.checked));
    this.checkBoxes.set(property, box);
    const label = h("label", { title: texts[`${property}Hint`], data: { inspect: property } }, box, texts[property]);
    return label;
  }

  private createDepthRow(): HTMLElement {
    const { inspect } = this.session;
    this.depthSlider.type = "range";
    this.depthSlider.min = "0";
    this.depthSlider.addEventListener("input", () => {
      const level = Number(this.depthSlider.value);
      inspect.maxDepth = level >= Number(this.depthSlider.max) ? null : level;
    });
    return h("label", { class: "inspect-depth" }, strings.description.inspect.depth, this.depthSlider, this.depthText);
  }

  private createScaleRow(): HTMLElement {
    const { inspect } = this.session;
    this.scaleSlider.type = "range";
    this.scaleSlider.min = String(-MAX_SCALE_EXPONENT);
    this.scaleSlider.max = String(MAX_SCALE_EXPONENT);
    this.scaleSlider.step = "0.25";
    this.scaleSlider.addEventListener("input", () => (inspect.scale = 2 ** Number(this.scaleSlider.value)));
    return h("label", {}, strings.description.inspect.scale, this.scaleSlider);
  }

  private show(): void {
    const { inspect } = this.session;
    const model = getCurrentModel(this.session);
    for (const [property, box] of this.checkBoxes) box.checked = inspect.current[property];
    this.openButton.classList.toggle("on", inspect.isActive);
    const maxDepth = model?.maxDepth ?? 0;
    this.depthSlider.parentElement?.toggleAttribute("hidden", !inspect.current.frames);
    this.depthSlider.max = String(maxDepth);
    this.depthSlider.value = String(inspect.maxDepth ?? maxDepth);
    this.depthText.textContent = this.depthSlider.value;
    this.scaleSlider.value = String(Math.log2(inspect.scale));
    for (const slider of [this.depthSlider, this.scaleSlider]) {
      const [min, max] = [Number(slider.min), Number(slider.max)];
      const fraction = max > min ? (Number(slider.value) - min) / (max - min) : 1;
      slider.style.setProperty("--part", String(fraction));
      slider.style.setProperty("--zero", slider === this.scaleSlider ? "0.5" : "0");
    }
    this.showFacts();
  }

  /** Shows what the robot lacks, its mass, and each implausible link; a click on a link selects it. */
  private showFacts(): void {
    const problems = this.listProblems().map((text) => h("div", { class: "missing" }, text));
    this.facts.replaceChildren(...problems, ...this.createMassFacts());
    this.facts.hidden = this.facts.childElementCount === 0;
  }

  /** Returns the reasons why enabled choices show nothing. */
  private listProblems(): string[] {
    const texts = strings.description.inspect;
    const { robot, inspect } = this.session;
    if (!robot) return [];
    const { contrast, joints } = inspect.current;
    const problems: string[] = [];
    if (joints && robot.joints.every(({ kind }) => kind === "fixed")) problems.push(texts.noJoints);
    if (contrast && robot.links.every(({ collisions }) => collisions.length === 0)) problems.push(texts.noCollisions);
    return problems;
  }

  private createMassFacts(): HTMLElement[] {
    const texts = strings.description.inspect;
    const model = getCurrentModel(this.session);
    const { centers, boxes, ellipsoids } = this.session.inspect.current;
    if (!model || !(centers || boxes || ellipsoids)) return [];
    const mass = [...model.links.values()].reduce((sum, { inertia }) => sum + (inertia?.mass ?? 0), 0);
    const findings = this.session.description.findingsOf(model.display);
    const links = new Set(findings.map(({ link }) => link));
    const hasNoInertia = links.size === 0 && [...model.links.values()].every(({ inertia }) => inertia === null);
    if (hasNoInertia) return [h("div", { class: "missing" }, texts.noInertials)];
    const rows = findings.map(({ link, code, message, hint }) => {
      const linkElement = { display: model.display, kind: "link" as const, name: link };
      const row = createButton(hint || message, () => this.session.focus.select(linkElement), "finding", h("strong", {}, link), ` ${message} `, h("code", { class: "code" }, code));
      return h("li", { data: { link } }, row);
    });
    return [
      h("div", {}, texts.mass(formatGeneral(mass))),
      h("div", {}, links.size > 0 ? texts.implausible(links.size) : texts.plausible),
      h("ul", {}, ...rows),
    ];
  }
}

import { createButton, h } from "../../dom";
import type { PoseNumbers } from "../../state/pose-numbers";
import type { SelectionState } from "../../state/selection";
import type { TipDrag } from "../../state/tip/tip-drag";
import { strings } from "../../strings";
import { formatFixed } from "../../tree/numbers";

/** The steps of the buttons: m and rad. */
const STEP_M = 0.01;
const STEP_RAD = Math.PI / 36;
const AXES = ["x", "y", "z"] as const;

/** The choice of the link that stays in place, buttons that move the tip by steps, and a line about the outcome. */
export class TipControls {
  readonly baseSelect = h("select", { class: "choice" });
  readonly steps = h("div", { class: "tip-steps" });
  readonly notice = h("p", { class: "hint tip-notice", role: "status" });

  constructor(
    private readonly tipDrag: TipDrag,
    private readonly selection: SelectionState,
  ) {
    const texts = strings.description.tip;
    this.baseSelect.setAttribute("aria-label", texts.base);
    this.baseSelect.title = texts.base;
    this.baseSelect.addEventListener("change", () => tipDrag.chooseBase(this.baseSelect.value));
    this.steps.append(this.createSteps("move"), this.createSteps("turn"));
    tipDrag.changed.on(() => this.show());
    this.show();
  }

  private createSteps(task: "move" | "turn"): HTMLElement {
    const texts = strings.description.tip;
    const buttons = AXES.flatMap((axis, i) =>
      [-1, 1].map((sign) => {
        const name = `${axis} ${sign < 0 ? "−" : "+"}`;
        const act = (): void => this.tipDrag.step(createStep(task, i, sign), task);
        return createButton(task === "move" ? texts.move(name) : texts.turn(name), act, "tool", name);
      }),
    );
    const label = task === "move" ? texts.moveLabel : texts.turnLabel;
    return h("div", { class: "bar-row", role: "group", aria: { label } }, h("span", { class: "bar-label" }, label), ...buttons);
  }

  private show(): void {
    const { chain, bases } = this.tipDrag;
    this.baseSelect.hidden = this.steps.hidden = chain === null;
    if ([...this.baseSelect.options].map(({ value }) => value).join("\n") !== bases.join("\n")) {
      this.baseSelect.replaceChildren(...bases.map((link) => new Option(link, link)));
    }
    if (chain) this.baseSelect.value = chain.base;
    const text = this.noticeText;
    this.notice.hidden = text === "";
    if (this.notice.textContent !== text) this.notice.textContent = text;
  }

  private get noticeText(): string {
    const texts = strings.description.tip;
    const { tipDrag, selection } = this;
    if (!tipDrag.isOn) return "";
    if (!selection.selectedLink) return texts.selectLink;
    if (!tipDrag.chain) return texts.noJoint(selection.selectedLink.link.name);
    const { outcome } = tipDrag;
    if (!outcome || outcome.isReached) return "";
    return texts.outOfReach(formatFixed(outcome.distanceM * 1000, 0), formatFixed((outcome.angleRad * 180) / Math.PI, 0));
  }
}

function createStep(task: "move" | "turn", axis: number, sign: number): PoseNumbers {
  const size = sign * (task === "move" ? STEP_M : Math.sin(STEP_RAD / 2));
  const [x = 0, y = 0, z = 0] = AXES.map((_, i) => (i === axis ? size : 0));
  return task === "move" ? [x, y, z, 0, 0, 0, 1] : [0, 0, 0, x, y, z, Math.cos(STEP_RAD / 2)];
}

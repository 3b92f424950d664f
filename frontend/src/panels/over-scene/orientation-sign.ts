import { h } from "../../dom";
import type { Session } from "../../state/session";
import type { ViewState } from "../../state/view";

const SIZE_PX = 64;
const ARM_LENGTH_PX = 22;
/** The distance of the letters from the center. */
const LABEL_DISTANCE_PX = ARM_LENGTH_PX + 6;
const SVG_NAMESPACE = "http://www.w3.org/2000/svg";
const AXES = ["x", "y", "z"] as const;

/** A small cross of axes that shows the orientation of the camera in the fixed frame. */
export class OrientationSign {
  readonly element = h("div", { class: "orientation", aria: { hidden: "true" } });
  private readonly svg = document.createElementNS(SVG_NAMESPACE, "svg");
  private readonly arms = AXES.map((name) => {
    const arm = document.createElementNS(SVG_NAMESPACE, "g");
    arm.setAttribute("class", `arm-${name}`);
    const [line, label] = [document.createElementNS(SVG_NAMESPACE, "line"), document.createElementNS(SVG_NAMESPACE, "text")];
    label.textContent = name;
    arm.append(line, label);
    return { arm, line, label };
  });

  private readonly view: ViewState;

  constructor({ view, frames }: Session) {
    this.view = view;
    this.svg.setAttribute("viewBox", `${-SIZE_PX / 2} ${-SIZE_PX / 2} ${SIZE_PX} ${SIZE_PX}`);
    this.svg.append(...this.arms.map(({ arm }) => arm));
    this.element.append(this.svg);
    view.changed.on(() => this.update());
    frames.posesChanged.on(() => {
      if (view.controller.followsYaw) this.update();
    });
    this.update();
  }

  private update(): void {
    const { right, up, back } = this.view.camera;
    const depths = this.arms.map(({ arm, line, label }, i) => {
      const [x, y, depth] = [right[i] ?? 0, -(up[i] ?? 0), back[i] ?? 0];
      line.setAttribute("x2", String(x * ARM_LENGTH_PX));
      line.setAttribute("y2", String(y * ARM_LENGTH_PX));
      label.setAttribute("x", String(x * LABEL_DISTANCE_PX));
      label.setAttribute("y", String(y * LABEL_DISTANCE_PX));
      return { arm, depth };
    });
    // Draw arms that point towards the viewer last.
    depths.sort((a, b) => a.depth - b.depth);
    this.svg.append(...depths.map(({ arm }) => arm));
  }
}

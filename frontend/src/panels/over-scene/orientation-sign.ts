import { h } from "../../dom";
import type { Session } from "../../state/session";
import type { ViewState } from "../../state/view";

const SIZE = 64;
const ARM = 22;
const SVG = "http://www.w3.org/2000/svg";
const AXES = ["x", "y", "z"] as const;

/** A small cross of axes that shows the orientation of the camera in the fixed frame. */
export class OrientationSign {
  readonly element = h("div", { class: "orientation", aria: { hidden: "true" } });
  private readonly svg = document.createElementNS(SVG, "svg");
  private readonly arms = AXES.map((name) => {
    const arm = document.createElementNS(SVG, "g");
    arm.setAttribute("class", `arm-${name}`);
    const [line, label] = [document.createElementNS(SVG, "line"), document.createElementNS(SVG, "text")];
    label.textContent = name;
    arm.append(line, label);
    return { arm, line, label };
  });

  private readonly view: ViewState;

  constructor({ view, frames }: Session) {
    this.view = view;
    this.svg.setAttribute("viewBox", `${-SIZE / 2} ${-SIZE / 2} ${SIZE} ${SIZE}`);
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
      line.setAttribute("x2", String(x * ARM));
      line.setAttribute("y2", String(y * ARM));
      label.setAttribute("x", String(x * (ARM + 6)));
      label.setAttribute("y", String(y * (ARM + 6)));
      return { arm, depth };
    });
    // Draw arms that point towards the viewer last.
    depths.sort((a, b) => a.depth - b.depth);
    this.svg.append(...depths.map(({ arm }) => arm));
  }
}

import { h } from "../../dom";
import { strings } from "../../strings";
import type { Panel } from "../panel";

const TF_CLASS = "rviz_default_plugins/TF";

/** RViz's Transformation panel, whose only choice is TF. */
export class TransformationPanel implements Panel {
  readonly id = "transformation";
  readonly icon = "axes";
  readonly element: HTMLElement;

  constructor() {
    const radio = h("input", { class: "check" });
    radio.type = "radio";
    radio.name = "transformer";
    radio.checked = true;
    this.element = h(
      "div",
      { class: "panel transformation-panel" },
      h("p", { class: "hint" }, strings.transformation.hint),
      h("label", { class: "labeled-row" }, radio, h("span", {}, strings.transformation.tf), h("span", { class: "row-badge" }, TF_CLASS)),
    );
  }
}

import { h } from "../dom";
import { strings } from "../strings";

/** Returns the notice that replaces the scene without WebGL. */
export function createNoWebglNotice(): HTMLElement {
  const { noWebgl, noWebglHelp } = strings.scene;
  return h("p", { class: "no-webgl", role: "alert" }, h("strong", {}, noWebgl), h("span", {}, noWebglHelp));
}

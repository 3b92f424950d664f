import { h } from "../dom";
import { strings } from "../strings";

/** The notice in place of the scene where it cannot be drawn. */
export function noWebgl(): HTMLElement {
  const { noWebgl, noWebglHelp } = strings.scene;
  return h("p", { class: "no-webgl", role: "alert" }, h("strong", {}, noWebgl), h("span", {}, noWebglHelp));
}

import type { Connection } from "../../connection/connection";
import { createButton, h } from "../../dom";
import { strings } from "../../strings";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";

const COMMANDS = ["next", "continue", "break", "stop"] as const;

/** The panel of rviz_visual_tools: lets a program continue that waits between its steps. */
export class VisualToolsPanel implements Panel {
  readonly id = "visual-tools";
  readonly icon = "step";
  readonly element: HTMLElement;

  constructor(connection: Connection) {
    const texts = strings.visualTools;
    const buttons = COMMANDS.map((command) =>
      createButton(texts.hints[command], () => connection.send({ type: "command_visual_tools", command }), "tool", texts.commands[command]),
    );
    this.element = h(
      "div",
      { class: "panel monitor" },
      h("div", { class: "scroll visual-tools" }, h("p", { class: "hint" }, texts.hint), h("div", { class: "toolbar" }, ...buttons)),
    );
    onVisibilityChange(this.element, (isVisible) => {
      if (isVisible) connection.send({ type: "command_visual_tools", command: "open" });
    });
  }
}

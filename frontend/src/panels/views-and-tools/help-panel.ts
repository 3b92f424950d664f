import { h } from "../../dom";
import type { ToolsState } from "../../state/tools";
import { strings } from "../../strings";
import type { Panel } from "../panel";

/** RViz's Help panel: what the mouse does, and the keys of the page. */
export class HelpPanel implements Panel {
  readonly id = "help";
  readonly icon = "info";
  readonly element = h("div", { class: "panel help-panel" });

  /** `createKeys` returns the keys of the page, one element for each group. */
  constructor(
    tools: ToolsState,
    private readonly createKeys: () => readonly HTMLElement[],
  ) {
    tools.listChanged.on(() => this.show());
    this.show();
  }

  private show(): void {
    const rows = strings.help.mouse.flatMap(({ action, meaning }) => [h("dt", {}, h("kbd", {}, action)), h("dd", {}, meaning)]);
    this.element.replaceChildren(
      h(
        "div",
        { class: "scroll key-columns" },
        h("section", {}, h("h2", {}, strings.help.mouseTitle), h("dl", {}, ...rows)),
        ...this.createKeys(),
      ),
    );
  }
}

import { h } from "../../dom";
import type { ToolsState } from "../../state/tools";

const NOTICE_DURATION_MS = 4000;

/** The notice over the scene, for some seconds, that explains why the active tool refused a request. */
export class ToolNotice {
  readonly element = h("div", { class: "line-notice", role: "status", data: { notice: "tool" } });
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(tools: ToolsState) {
    this.element.hidden = true;
    tools.noticeShown.on((text) => this.show(text));
    tools.currentChanged.on(() => this.show(""));
  }

  private show(text: string): void {
    clearTimeout(this.timer);
    this.element.hidden = text === "";
    this.element.textContent = text;
    if (text !== "") this.timer = setTimeout(() => this.show(""), NOTICE_DURATION_MS);
  }
}

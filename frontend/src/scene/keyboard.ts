import type { Session } from "../state/session";
import type { Controls } from "./controls";
import type { Stage } from "./stage";
import { TOOLS } from "./tools/catalog";
import type { Toolbox } from "./tools/toolbox";

/** Selects the elements in which a letter is text, or chooses an entry. */
export const LETTER_INPUT_SELECTOR = "input:not([type=checkbox]):not([type=range]):not([type=button]), textarea, select, [contenteditable], [role=menu], [role=listbox], dialog";

/** RViz's keys for tools and views, which work wherever no text is typed. */
export class Keyboard {
  constructor(
    private readonly session: Session,
    private readonly stage: Stage,
    private readonly toolbox: Toolbox,
    private readonly controls: Controls,
  ) {
    document.addEventListener("keydown", (event) => {
      if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.target instanceof Element && event.target.closest(LETTER_INPUT_SELECTOR)) return;
      if (this.handleKey(event.key.length === 1 ? event.key.toLowerCase() : event.key, event.shiftKey)) event.preventDefault();
    });
  }

  private handleKey(key: string, isShiftDown: boolean): boolean {
    const { session, toolbox } = this;
    const { tools } = session;
    if (key === "Escape") return this.handleEscape();
    const tool = tools.tools.find((candidate) => candidate.isSupported && TOOLS.get(candidate.cls)?.key === key);
    if (tool && (tool === tools.current || toolbox.current.grabsKeys !== true)) {
      tools.toggle(tool);
      return true;
    }
    if (toolbox.current.pressKey?.(key) === true && (tool || (key === "f" && !isShiftDown))) return true;
    switch (key) {
      case "f":
        if (isShiftDown) this.stage.fit();
        else this.focus();
        return true;
      case "z":
        if (isShiftDown) session.view.reset();
        else session.view.zero();
        return true;
      case "r":
        session.time.reset();
        return true;
      default:
        return false;
    }
  }

  /** Activates the default tool; if it is active already, clears the selection. */
  private handleEscape(): boolean {
    const { tools, selection } = this.session;
    if (tools.current !== tools.default) tools.activate(tools.default);
    else selection.select(null);
    return true;
  }

  /** Looks at the point under the pointer; without one, fits the selection, or everything, into view. */
  private focus(): void {
    const { position } = this.controls;
    const point = position && this.stage.picker.pointAt(position.x, position.y);
    if (point) this.session.view.lookAt(point);
    else this.stage.fit();
  }
}

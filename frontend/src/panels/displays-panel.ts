import { h } from "../dom";
import type { Session } from "../state/session";
import { strings } from "../strings";
import { TreeView } from "../tree/tree-view";
import { displayItems, linkOfKey, linkPath } from "./display-items";
import type { Panel } from "./panel";

/** RViz's Displays panel: the property tree and, below it, what the selected row means. */
export class DisplaysPanel implements Panel {
  readonly id = "displays";
  readonly icon = "displays";
  readonly element: HTMLElement;
  private readonly tree: TreeView;
  private readonly help = h("div", { class: "help" }, h("p", { class: "hint" }, strings.tree.helpHint));

  constructor(private readonly session: Session) {
    this.tree = new TreeView(strings.panels.displays, () => displayItems(session), () => session.frames.names);
    this.element = h("div", { class: "panel displays-panel" }, this.tree.element, this.help);
    const { displays, selection, frames } = session;
    for (const signal of [displays.treeChanged, displays.rowsChanged, displays.valueChanged]) {
      (signal as { on(listener: () => void): void }).on(this.tree.refresh);
    }
    displays.statusChanged.on(this.tree.refresh);
    displays.enabledChanged.on(this.tree.refresh);
    frames.tableChanged.on(this.tree.refresh);
    this.tree.selected.on((item) => {
      this.explain(item.name, item.description);
      this.selectLink(item.key);
    });
    selection.changed.on(() => this.showSelection());
  }

  private explain(name: string, description: string): void {
    this.help.replaceChildren(h("strong", {}, name), h("p", {}, description));
  }

  private selectLink(key: string): void {
    const found = linkOfKey(this.session, key);
    const link = found && this.session.robots.get(found.display.id)?.links.find((each) => each.name === found.link);
    if (found && link) this.session.selection.select({ display: found.display.id, link });
  }

  private showSelection(): void {
    const { selected } = this.session.selection;
    const display = selected && this.session.displays.find(selected.display);
    const path = display && linkPath(display, selected.link.name);
    if (path) this.tree.reveal(path);
  }
}

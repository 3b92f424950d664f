import { h } from "../../dom";
import type { DescriptionRow } from "../../scene/picking";
import type { SelectedItem } from "../../state/selection";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import type { TreeItem } from "../../tree/tree-item";
import { TreeView } from "../../tree/tree-view";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";

/** The interval at which values of the selection are read while they change. */
const REFRESH_INTERVAL_MS = 250;

/** RViz's Selection panel: the selection, and the properties that its display reports. */
export class SelectionPanel implements Panel {
  readonly id = "selection";
  readonly icon = "select";
  readonly element: HTMLElement;
  private readonly emptyHint = h("p", { class: "hint empty" }, strings.selected.none);
  private readonly tree: TreeView;
  private timer = 0;

  constructor(
    private readonly session: Session,
    private readonly describe: (item: SelectedItem) => DescriptionRow | null,
  ) {
    this.tree = new TreeView(
      strings.selected.label,
      () => this.createItems(),
      () => [],
    );
    this.element = h("div", { class: "panel" }, this.emptyHint, this.tree.element);
    session.selection.changed.on(this.tree.refresh);
    onVisibilityChange(this.element, this.tree.refresh);
    session.frames.posesChanged.on(() => this.scheduleRefresh());
    session.data.received.on(() => this.scheduleRefresh());
  }

  private scheduleRefresh(): void {
    if (this.timer !== 0 || this.session.selection.items.length === 0 || this.element.offsetParent === null) return;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      this.tree.refresh();
    }, REFRESH_INTERVAL_MS);
  }

  private createItems(): TreeItem[] {
    const { items } = this.session.selection;
    this.emptyHint.hidden = items.length > 0;
    const rows: TreeItem[] = [];
    for (const item of items) {
      const description = this.describe(item);
      if (description) rows.push(createRow(`${item.display} ${item.key}`, description, items.length === 1));
    }
    return rows;
  }
}

function createRow(key: string, { name, value = "", children }: DescriptionRow, isExpanded: boolean): TreeItem {
  return {
    key,
    name,
    kind: "group",
    value,
    description: "",
    isExpanded,
    ...(children ? { children: () => children.map((child) => createRow(`${key}/${child.name}`, child, false)) } : {}),
  };
}

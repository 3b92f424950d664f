import { h } from "../../dom";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { createPropertyItem } from "../../tree/property-item";
import type { TreeItem } from "../../tree/tree-item";
import { TreeView } from "../../tree/tree-view";
import { translateToolName } from "../over-scene/toolbar";
import type { Panel } from "../panel";

/** RViz's Tool Properties panel: the settings of all tools that have any. */
export class ToolPropertiesPanel implements Panel {
  readonly id = "tool-properties";
  readonly icon = "options";
  readonly element: HTMLElement;
  private readonly emptyHint = h("p", { class: "hint empty" }, strings.tools.nothing);

  constructor(private readonly session: Session) {
    const { tools, frames } = session;
    const tree = new TreeView(
      strings.panels["tool-properties"],
      () => this.createItems(),
      () => frames.names,
    );
    this.element = h("div", { class: "panel" }, tree.element, this.emptyHint);
    tools.listChanged.on(tree.refresh);
    tools.valueChanged.on(tree.refresh);
  }

  private createItems(): TreeItem[] {
    const { tools } = this.session;
    const items = tools.tools
      .filter((tool) => tool.rows.nodes.length > 0)
      .map((tool): TreeItem => ({
        key: tool.id,
        name: translateToolName(tool),
        kind: "group",
        value: "",
        description: "",
        isStrong: true,
        isExpanded: true,
        children: () => tool.rows.nodes.map((node) => createPropertyItem(node, (id, value) => tools.setProperty(id, value))),
      }));
    this.emptyHint.hidden = items.length > 0;
    return items;
  }
}

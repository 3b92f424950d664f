import type { Connection } from "../connection/connection";
import type { PropertyValue, Tool, ToolClass } from "../protocol";
import { Signal } from "../signal";
import type { Kept } from "./kept";
import { PropertyNode, PropertyRows } from "./properties";

/** A tool of the toolbar. */
export class ToolState {
  readonly id: string;
  readonly cls: string;
  readonly name: string;
  readonly supported: boolean;
  readonly rows: PropertyRows;

  constructor(tool: Tool) {
    this.id = tool.id;
    this.cls = tool.cls;
    this.name = tool.name;
    this.supported = tool.supported;
    this.rows = new PropertyRows(tool.properties.map((property) => new PropertyNode(property)));
  }
}

/** The tools of the file, and the one that is active in this page. */
export class ToolsState {
  /** The list of tools changed. */
  readonly listChanged = new Signal();
  /** The active tool changed. */
  readonly currentChanged = new Signal<ToolState | null>();
  readonly valueChanged = new Signal<ToolState>();
  readonly hintChanged = new Signal<string>();
  /** Why the active tool did not do what was requested; empty to hide the notice. */
  readonly told = new Signal<string>();
  tools: readonly ToolState[] = [];
  /** The classes of tools that can be added. */
  classes: readonly ToolClass[] = [];
  private inHand: ToolState | null = null;
  private text = "";
  /** The ID of the tool that was active before the reload of the page. */
  private before: string | null = null;

  constructor(private readonly connection: Connection) {
    connection.on("tools", ({ tools, classes }) => this.take(tools, classes));
    connection.on("tool_property_changed", ({ id, value }) => this.setValue(id, value));
  }

  /** Preserves the choice of the active tool across reloads of the page. */
  keep(kept: Kept): void {
    kept.part("tool", () => this.inHand?.id ?? null, (id) => (this.before = id));
  }

  get current(): ToolState | null {
    return this.inHand;
  }

  /** The default tool: the first one. */
  get default(): ToolState | null {
    return this.tools.find((tool) => tool.supported) ?? null;
  }

  /** The text of the status line about the mouse. */
  get hint(): string {
    return this.text;
  }

  set hint(text: string) {
    if (text === this.text) return;
    this.text = text;
    this.hintChanged.emit(text);
  }

  /** Activates a tool. */
  choose(tool: ToolState | null): void {
    if (tool === this.inHand || tool?.supported === false) return;
    this.inHand = tool;
    this.currentChanged.emit(tool);
  }

  /** Activates a tool, or the default tool if it is active already. */
  toggle(tool: ToolState): void {
    this.choose(tool === this.inHand ? this.default : tool);
  }

  setProperty(id: string, value: PropertyValue): void {
    this.setValue(id, value);
    this.connection.send({ type: "set_tool_property", id, value });
  }

  add(cls: string): void {
    this.connection.send({ type: "add_tool", cls });
  }

  remove(id: string): void {
    this.connection.send({ type: "remove_tool", id });
  }

  private take(tools: readonly Tool[], classes: readonly ToolClass[]): void {
    const before = this.inHand?.id ?? this.before;
    this.tools = tools.map((tool) => new ToolState(tool));
    this.classes = classes;
    this.inHand = this.tools.find((tool) => tool.id === before && tool.supported) ?? this.default;
    this.listChanged.emit();
    this.currentChanged.emit(this.inHand);
  }

  private setValue(id: string, value: PropertyValue): void {
    for (const tool of this.tools) {
      const node = tool.rows.nodes.flatMap((top) => [...top.walk()]).find((each) => each.id === id);
      if (!node || node.value === value) continue;
      node.value = value;
      this.valueChanged.emit(tool);
    }
  }
}

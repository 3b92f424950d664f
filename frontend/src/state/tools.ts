import type { Connection } from "../connection/connection";
import type { PropertyValue, Tool, ToolClass } from "../protocol";
import { Signal } from "../signal";
import type { PageMemory } from "./page-memory";
import { PropertyNode, PropertyRows } from "./properties";

/** A tool of the toolbar. */
export class ToolState {
  readonly id: string;
  readonly cls: string;
  readonly name: string;
  readonly isSupported: boolean;
  readonly rows: PropertyRows;

  constructor(tool: Tool) {
    this.id = tool.id;
    this.cls = tool.cls;
    this.name = tool.name;
    this.isSupported = tool.supported;
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
  /** Why the active tool refused a request; empty to hide the notice. */
  readonly noticeShown = new Signal<string>();
  tools: readonly ToolState[] = [];
  /** The classes of tools that can be added. */
  classes: readonly ToolClass[] = [];
  private activeTool: ToolState | null = null;
  private hintText = "";
  /** The ID of the tool that was active before the reload of the page. */
  private previousActiveId: string | null = null;

  constructor(private readonly connection: Connection) {
    connection.on("tools", ({ tools, classes }) => this.setTools(tools, classes));
    connection.on("tool_property_changed", ({ id, value }) => this.setValue(id, value));
  }

  /** Preserves the choice of the active tool across reloads of the page. */
  preserveIn(memory: PageMemory): void {
    memory.preserve("tool", () => this.activeTool?.id ?? null, (id) => (this.previousActiveId = id));
  }

  get current(): ToolState | null {
    return this.activeTool;
  }

  /** The default tool: the first supported one. */
  get default(): ToolState | null {
    return this.tools.find((tool) => tool.isSupported) ?? null;
  }

  /** The text of the status line about the mouse. */
  get hint(): string {
    return this.hintText;
  }

  set hint(text: string) {
    if (text === this.hintText) return;
    this.hintText = text;
    this.hintChanged.emit(text);
  }

  /** Activates a tool. */
  activate(tool: ToolState | null): void {
    if (tool === this.activeTool || tool?.isSupported === false) return;
    this.activeTool = tool;
    this.currentChanged.emit(tool);
  }

  /** Activates a tool, or the default tool if it is active already. */
  toggle(tool: ToolState): void {
    this.activate(tool === this.activeTool ? this.default : tool);
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

  private setTools(tools: readonly Tool[], classes: readonly ToolClass[]): void {
    const previousId = this.activeTool?.id ?? this.previousActiveId;
    this.tools = tools.map((tool) => new ToolState(tool));
    this.classes = classes;
    this.activeTool = this.tools.find((tool) => tool.id === previousId && tool.isSupported) ?? this.default;
    this.listChanged.emit();
    this.currentChanged.emit(this.activeTool);
  }

  private setValue(id: string, value: PropertyValue): void {
    for (const tool of this.tools) {
      const node = tool.rows.nodes.flatMap((top) => [...top.walk()]).find((row) => row.id === id);
      if (!node || node.value === value) continue;
      node.value = value;
      this.valueChanged.emit(tool);
    }
  }
}

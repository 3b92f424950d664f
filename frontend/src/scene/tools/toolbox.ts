import type { Session } from "../../state/session";
import type { ToolState } from "../../state/tools";
import type { Stage } from "../stage";
import { TOOLS } from "./catalog";
import { MoveCameraTool } from "./move-camera";
import type { SceneTool, ToolContext } from "./tool";

/** The tools of the toolbar. The active tool handles the mouse. */
export class Toolbox {
  private readonly tools = new Map<string, { state: ToolState; tool: SceneTool }>();
  /** The tool that is active while the toolbar has none. */
  private readonly fallbackTool: SceneTool;
  private activeTool: SceneTool;

  constructor(
    private readonly stage: Stage,
    private readonly session: Session,
  ) {
    const { tools, view } = session;
    this.fallbackTool = this.activeTool = new MoveCameraTool(this.createContext(null));
    this.fallbackTool.activate?.();
    tools.currentChanged.on((state) => this.activate(state));
    tools.valueChanged.on((state) => this.tools.get(state.id)?.tool.onSettingsChanged?.());
    // In another class of view the mouse works differently: update the tool's hint.
    let { cls } = view.current;
    view.changed.on(() => {
      if (cls === view.current.cls) return;
      cls = view.current.cls;
      this.activeTool.activate?.();
    });
    this.activate(tools.current);
  }

  get current(): SceneTool {
    return this.activeTool;
  }

  private activate(state: ToolState | null): void {
    this.disposeRemoved();
    const newTool = state ? this.findOrCreateTool(state) : this.fallbackTool;
    if (newTool === this.activeTool) return;
    this.activeTool.deactivate?.();
    this.activeTool = newTool;
    newTool.activate?.();
  }

  private findOrCreateTool(state: ToolState): SceneTool {
    const existing = this.tools.get(state.id);
    if (existing) return existing.tool;
    const Tool = TOOLS.get(state.cls)?.toolClass;
    const tool = Tool ? new Tool(this.createContext(state)) : this.fallbackTool;
    this.tools.set(state.id, { state, tool });
    return tool;
  }

  /** Disposes of tools that the server has removed or replaced. */
  private disposeRemoved(): void {
    const { tools } = this.session.tools;
    for (const [id, { state, tool }] of this.tools) {
      if (tools.includes(state)) continue;
      if (tool === this.activeTool) {
        tool.deactivate?.();
        this.activeTool = this.fallbackTool;
      }
      tool.dispose?.();
      this.tools.delete(id);
    }
  }

  private createContext(state: ToolState | null): ToolContext {
    const { stage, session } = this;
    const { tools } = session;
    return {
      stage,
      session,
      state,
      setHint: (text) => {
        tools.hint = text;
      },
      showNotice: (text) => tools.noticeShown.emit(text),
      setCursor: (cursor) => {
        stage.viewport.canvas.style.cursor = cursor;
      },
      finish: () => tools.activate(tools.default),
    };
  }
}

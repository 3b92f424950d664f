import type { AddPanelOptions, Direction, DockviewApi, IContentRenderer } from "dockview";
import { h } from "../../dom";
import type { DisplayPanel, PanelHost } from "../../scene/displays/display-panel";
import { formOf } from "./default-layout";
import { PanelTab } from "./panel-tab";

const PREFIX = "display:";
const HEIGHT = 220;
/** The largest share of the window's height for a panel. */
const MAX_HEIGHT_SHARE = 0.3;
/** The number of panels below the Displays panel; further ones become tabs of these. */
const MAX_BELOW = 2;
/**
 * Pixels; in a narrow window of at least this width, the first panel opens beside the scene with this share of the
 * width.
 */
const MIN_SPLIT_WIDTH = 600;
const SPLIT = 0.42;
/** Pixels; in a lower window, only one panel opens below the Displays panel. */
const LOW = 700;

interface Placement {
  beside: string | undefined;
  direction: Direction;
  width?: number;
  height?: number;
  inactive?: boolean;
}

/** The panels of displays within the dock. A restored arrangement reserves their places until their displays arrive. */
export class DisplayPanels implements PanelHost {
  private readonly hosts = new Map<string, HTMLElement>();
  private readonly panels = new Map<string, DisplayPanel>();

  /** `api` is a function because the dock creates contents while it is itself being created. */
  constructor(private readonly api: () => DockviewApi) {}

  offer(panel: DisplayPanel): void {
    this.panels.set(panel.key, panel);
    if (this.api().getPanel(panel.key)) {
      this.host(panel.key).replaceChildren(panel.element);
      this.retitle(panel.key, panel.title);
    } else {
      this.add(panel);
    }
  }

  withdraw(key: string): void {
    this.panels.delete(key);
    this.remove(key);
  }

  retitle(key: string, title: string): void {
    this.api().getPanel(key)?.api.setTitle(title);
  }

  /** Removes the panels of displays that are not in the list. */
  prune(displays: readonly string[]): void {
    const keys = new Set(displays.map((id) => PREFIX + id));
    for (const { id } of [...this.api().panels]) if (id.startsWith(PREFIX) && !keys.has(id)) this.withdraw(id);
  }

  /** Adds all panels again after the arrangement was cleared. */
  restore(): void {
    for (const panel of this.panels.values()) if (!this.api().getPanel(panel.key)) this.add(panel);
  }

  /** Returns the content of a panel for the dock; null for a panel that belongs to no display. */
  content(name: string): IContentRenderer | null {
    if (!name.startsWith(PREFIX)) return null;
    return { element: this.host(name), init: () => undefined };
  }

  /** Returns the tab of a panel; null for a panel that belongs to no display. */
  tab(key: string): PanelTab | null {
    if (!key.startsWith(PREFIX)) return null;
    const close = (): void => {
      const panel = this.panels.get(key);
      if (panel) panel.onClosed();
      else this.remove(key);
    };
    return new PanelTab(this.panels.get(key)?.icon ?? "image", true, close);
  }

  private add(panel: DisplayPanel): void {
    const { key, title, element } = panel;
    this.host(key).replaceChildren(element);
    const others = this.api().panels.filter(({ id }) => id.startsWith(PREFIX));
    const home = this.home(panel, others.at(-1)?.id, others.length);
    const { width, height, inactive } = home;
    const options: AddPanelOptions = { id: key, component: key, tabComponent: key, title };
    if (width !== undefined) options.initialWidth = width;
    if (height !== undefined) options.initialHeight = height;
    if (inactive !== undefined) options.inactive = inactive;
    const position = home.beside === undefined ? undefined : { referencePanel: home.beside, direction: home.direction };
    const before = others.map(({ group }) => ({ group, height: group.height }));
    const { group } = this.api().addPanel(position ? { ...options, floating: false, position } : options);
    if (height === undefined) return;
    // The dock takes the space from the other panels: restore their heights.
    for (const each of [...before, { group, height }]) each.group.api.setSize({ height: each.height });
  }

  /** Returns the place of a new panel, after `count` others. */
  private home({ replacesScene }: DisplayPanel, last: string | undefined, count: number): Placement {
    const api = this.api();
    const form = formOf(api);
    const narrow = form !== "wide";
    // Where all panels share a group, a new image must not hide the panel that the user works with.
    const shares = form === "low" || (narrow && api.width < MIN_SPLIT_WIDTH);
    const most = narrow || api.height < LOW ? 1 : MAX_BELOW;
    if (last !== undefined && replacesScene && count < MAX_BELOW) return { beside: last, direction: "right" };
    if (last !== undefined && count >= most) return { beside: last, direction: "within", inactive: shares && !replacesScene };
    const scene = api.getPanel("scene") && "scene";
    if (replacesScene && scene) return { beside: scene, direction: "within" };
    if (narrow && !shares && scene) return { beside: scene, direction: "right", width: Math.round(api.width * SPLIT) };
    const beside = api.getPanel("displays") ? "displays" : scene;
    if (shares) return { beside, direction: "within", inactive: beside !== undefined };
    return { beside, direction: "below", height: Math.min(HEIGHT, Math.round(api.height * MAX_HEIGHT_SHARE)) };
  }

  private remove(key: string): void {
    const panel = this.api().getPanel(key);
    if (panel) this.api().removePanel(panel);
    this.hosts.delete(key);
  }

  private host(key: string): HTMLElement {
    let host = this.hosts.get(key);
    if (!host) this.hosts.set(key, (host = h("div", { class: "display-panel-host" })));
    return host;
  }
}

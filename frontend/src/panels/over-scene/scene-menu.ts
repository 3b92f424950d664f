import { h } from "../../dom";
import type { Signal } from "../../signal";
import type { MenuChoice, SceneMenu } from "../../state/scene-menu";
import { openMenu } from "../../widgets/menu";

/**
 * Opens context menus of objects in the scene at the requested positions; a choice with submenu entries opens those.
 */
export function bindSceneMenus(container: HTMLElement, menuRequested: Signal<SceneMenu>): void {
  const anchor = h("div", { class: "scene-menu-anchor" });
  container.append(anchor);
  const open = (choices: readonly MenuChoice[]): void => {
    openMenu(
      anchor,
      choices.map(({ label, run, choices: submenu }) => ({
        label: submenu ? `${label} ›` : label,
        run: () => {
          if (submenu) open(submenu);
          else run?.();
        },
      })),
    );
  };
  menuRequested.on(({ x, y, choices }) => {
    anchor.style.left = `${x}px`;
    anchor.style.top = `${y}px`;
    open(choices);
  });
}

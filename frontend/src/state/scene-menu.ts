/** An entry of a menu in the scene; it runs a command or opens a submenu. */
export interface MenuChoice {
  label: string;
  run?: () => void;
  choices?: readonly MenuChoice[];
}

/** A menu to open at a position on the canvas, pixels from its upper left corner. */
export interface SceneMenu {
  x: number;
  y: number;
  choices: readonly MenuChoice[];
}

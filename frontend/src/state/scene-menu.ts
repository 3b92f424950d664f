/** A line of a menu that something in the scene opens; it runs, or opens others. */
export interface MenuChoice {
  label: string;
  run?: () => void;
  choices?: readonly MenuChoice[];
}

/** A menu requested at a place of the canvas, pixels from its upper left corner. */
export interface SceneMenu {
  x: number;
  y: number;
  choices: readonly MenuChoice[];
}

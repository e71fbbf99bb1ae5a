// The mask: how it is shown, and its brushes.
export const mask = {
  title: "Mask of the person",
  proposed: "proposed",
  chosen: "from a file",
  edited: "edited",
  help: "This is taken for the person; its border is refined later. Paint what is missing, erase what does not belong.",
  editedHelp: "Exactly what you painted is used.",
  preview: "The picture with the mask",
  shown: "The mask over the picture",
  edit: "Look and adjust",
  done: "Done",
  reset: "Discard the edits",
  undo: "Undo the last stroke",
  redo: "Redo the stroke",
  tools: "Mask",
  brush: "Brush",
  brushes: { add: "Add", remove: "Remove" },
  size: "Size",
  stage: (brush: string) => `Picture with its mask. Brush: ${brush}.`,
  keys:
    "Drag to paint, with Shift to move the picture. Arrow keys move the brush, Shift moves ten pixels, Enter dabs, X changes the brush, square brackets its size, plus and minus zoom, 0 shows the whole picture, Control Z undoes.",
  tooLarge: "This browser cannot draw a mask as large as the picture. Use a smaller picture, or discard the edits.",
} as const;

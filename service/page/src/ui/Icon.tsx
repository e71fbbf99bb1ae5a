// A small set of line drawings on a 20 x 20 grid.

const PATHS = {
  plus: "M10 4v12M4 10h12",
  minus: "M4 10h12",
  frame: "M4 8V4h4M12 4h4v4M16 12v4h-4M8 16H4v-4",
  full: "M12 4h4v4M16 4l-5 5M8 16H4v-4M4 16l5-5",
  undo: "M8 4 4 8l4 4M4 8h8a4 4 0 0 1 0 8h-3",
  redo: "m12 4 4 4-4 4M16 8H8a4 4 0 0 0 0 8h3",
  skip: "m5 5 6 5-6 5zM14.5 5v10",
  hidden: "M3 3l14 14M8.2 5.3A8.6 8.6 0 0 1 10 5c4 0 6.6 3.2 7.5 5a12 12 0 0 1-2.2 2.8M5.6 6.8A12 12 0 0 0 2.5 10c.9 1.8 3.5 5 7.5 5a8 8 0 0 0 3-.6",
  back: "M16 10H4m5-5-5 5 5 5",
  swap: "M4 7h12m-3-3 3 3-3 3M16 13H4m3-3-3 3 3 3",
  trash: "M4 6h12M8 6V4h4v2M6 6l.7 10h6.6L14 6",
  download: "M10 3v9m-4-3.5 4 4 4-4M4 16h12",
  upload: "M10 13V4M6 7.5l4-4 4 4M4 16h12",
  share: "M10 12V3M6.5 6.5 10 3l3.5 3.5M6 9H4.5v8h11V9H14",
  link: "M8.5 11.5a3 3 0 0 0 4.3 0l2.5-2.5a3 3 0 0 0-4.3-4.3L10 5.7M11.5 8.5a3 3 0 0 0-4.3 0L4.7 11A3 3 0 0 0 9 15.3l1-1",
  close: "m5 5 10 10M15 5 5 15",
  check: "m4 10.5 4 4 8-9",
  picture: "M3 4h14v12H3zM3 13l4-4 4 4 2.5-2.5L17 14M13 7.5h.01",
  again: "M15.5 8A6 6 0 1 0 16 11M16 4v4h-4",
  body: "M10 4.5h.01M6 8.5h8M10 8.5V12M10 12l-2.5 5M10 12l2.5 5",
  list: "M7 5h10M7 10h10M7 15h10M3.5 5h.01M3.5 10h.01M3.5 15h.01",
  theme: "M10 3a7 7 0 1 0 0 14zM10 3a7 7 0 0 1 0 14",
} as const;

export type IconName = keyof typeof PATHS;

export function Icon({ name }: { name: IconName }) {
  return (
    <svg class="icon" width="20" height="20" viewBox="0 0 20 20" aria-hidden="true" focusable="false">
      <path d={PATHS[name]} />
    </svg>
  );
}

// Good pictures and bad ones, side by side: captions, within a sentence.
export const howto = {
  title: "Good and bad pictures",
  good: (what: string) => `Good: ${what}`,
  bad: (what: string) => `Bad: ${what}`,
  tiles: {
    front: { what: "front", remedy: "Arms well away from the body, feet apart." },
    armsForward: { what: "side, arms forward", remedy: "Arms level, feet together." },
    armsHanging: { what: "side, arms hanging", remedy: "Arms relaxed, feet together." },
    "cut-off": { what: "feet cut off", remedy: "Leave room above the head and below the feet." },
    "person-too-small": { what: "too far away", remedy: "Go nearer: two to three metres." },
    "picture-too-small": { what: "a thumbnail", remedy: "Send the picture the camera took." },
    "camera-too-near": { what: "too near", remedy: "Step back, and leave the wide lens." },
    "camera-rolled": { what: "tilted camera", remedy: "Hold the phone level." },
    "other-view": { what: "turned half away", remedy: "Face the camera, or turn by a quarter." },
    "arms-against-trunk": { what: "arms on the body", remedy: "Let the wall show between arms and body." },
    "clothes-loose": { what: "loose clothes", remedy: "Wear tight ones." },
    blurred: { what: "blurred", remedy: "Put the phone on something, and focus." },
    "too-dark": { what: "too dark", remedy: "More light, from the camera’s side." },
    "too-bright": { what: "too bright", remedy: "Out of the glare." },
    "several-people": { what: "somebody else", remedy: "One person in the picture." },
  },
} as const;

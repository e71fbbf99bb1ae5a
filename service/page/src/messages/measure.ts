// Pictures by where they show the person from, and what is found in them.
export const measure = {
  views: {
    front: { label: "Front", title: "Front picture" },
    side: { label: "Side", title: "Side picture" },
    back: { label: "Back", title: "Back picture" },
    other: { label: "Other", title: "Other picture" },
  },
  findings: { blocks: "Take it again", harms: "Could be better" },
} as const;

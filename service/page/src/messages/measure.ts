// A person measured from the front and from the side: the pictures, the camera, and what came out.
import { plural } from "./figures";

export const measure = {
  title: "Measure a person",
  lead: "Two pictures, from the front and from the side, and a height.",
  noHeight: "The height is needed: pictures alone do not tell how large a body is.",
  weight: "If you know it, the weight makes measurements better.",
  noPictures: "No pictures at hand?",
  trySample: "Try the sample pair",
  leftOut: (count: number) =>
    `The scan has ${plural(count, { one: "one more picture", other: `${count} more pictures` })}. This screen takes one from the front and one from the side, and leaves out the rest.`,
  rules: {
    title: "For good measurements",
    list: [
      "Tight clothes or underwear, hair tied up, no shoes.",
      "Phone upright and level, at belly height, two to three metres away; stood on something or held by somebody.",
      "Head to feet in the picture, with some room around.",
      "Light from the camera’s side, in front of a wall of another colour than skin and clothes.",
      "Breathe out, stand relaxed, do not draw in the belly. Both pictures from the same place: turn yourself, not the camera.",
      "Pictures from the phone’s own camera app, chosen as files, are best: they say which lens took them.",
    ],
  },
  noDetector: {
    title: "This service cannot find the person by itself",
    why: "Its detector is not installed. Click the joints by hand instead: that measures from one picture.",
    openFront: "Click on the front picture",
    toEditor: "Choose a picture to click on",
  },
  /** Pictures by where they show the person from: as a label, and within a sentence without its article. */
  views: {
    front: { label: "Front", picture: "front picture" },
    side: { label: "Side", picture: "side picture" },
    back: { label: "Back", picture: "back picture" },
    other: { label: "Other", picture: "other picture" },
  },
  ofPicture: (picture: string) => `The ${picture}`,
  /** One of several pictures of the same kind. */
  viewNumber: (view: string, number: number) => `${view} ${number}`,
  place: {
    stances: {
      front: "Face the camera. Feet apart as wide as the shoulders, arms well away from the body.",
      side: "Turn to either side. Feet together, arms stretched forward, looking ahead.",
    },
    drawn: {
      front: "Drawn: a person from the front, arms and legs apart",
      side: "Drawn: a person from the side, legs together, arms stretched forward",
    },
    take: "Take a picture",
    takeAgain: "Take again",
    takeNamed: (picture: string) => `Take the ${picture}`,
    choose: "Choose a file",
    chooseOther: "Other file",
    chooseNamed: (picture: string) => `Choose a file: ${picture}`,
    looking: "Looking at the picture …",
    good: "Good to measure",
    /** Read out when a picture has been looked at. */
    told: (view: string, said: string) => `${view}: ${said}`,
  },
  findings: { blocks: "Take it again", harms: "Could be better" },
  unusable: "This picture cannot be measured",
  todo: {
    height: "Give the height",
    add: (picture: string) => `Add the ${picture}`,
    again: (picture: string) => `Take the ${picture} again`,
    noDetector: "Points cannot be proposed here",
  },
  submit: "Measure",
  anyway: {
    title: "Measure all the same?",
    ask: (pictures: readonly string[]) => `The ${pictures.join(" and the ")} should be taken again. Measure all the same?`,
    back: "Back",
  },
  camera: {
    label: (picture: string) => `Camera: ${picture}`,
    sees: "What the camera sees",
    taken: "Taken",
    chooseInstead: (picture: string) => `Choose a file instead: ${picture}`,
    countdown: "Countdown",
    useBack: "Use the back camera",
    useFront: "Use the front camera",
    stop: "Stop",
    takeIn: (seconds: string) => `Take it in ${seconds}`,
    troubles: {
      forbidden: "The camera is blocked for this page. Allow it in the browser’s settings, or choose a file.",
      none: "No camera was found. Choose a file instead.",
      used: "Another program uses the camera. Close it, or choose a file.",
      unusable: "The camera cannot be used here. Choose a file instead.",
      noPicture: "The camera gave no picture. Try again, or choose a file.",
    },
  },
  level: {
    level: "Level",
    left: "Turn the phone to the left",
    right: "Turn the phone to the right",
    down: "The camera looks up: tilt it down",
    up: "The camera looks down: tilt it up",
  },
  quality: {
    contradicted: "One picture does not show the person as it should. Take it again.",
    differentPeople: "The pictures contradict each other. Do not trust these measurements.",
    poor: "Poor: take a picture again. The notes say which.",
    fair: "Fair: better pictures would measure better. The notes say how.",
    good: "Good: the pictures are fine, and they agree.",
    rarely: (share: string) => `The two pictures disagree: for one person that happens in only ${share} of cases. Check that both show the same person, dressed alike.`,
    nearlyAlways: "The two pictures agree very well.",
    often: (share: string) => `The two pictures agree as well as those of one person usually do: ${share} of such pairs differ more.`,
  },
  /** How many of a picture's points nobody clicked. */
  proposed: {
    all: (picture: string) => `all of the ${picture}`,
    some: (count: number, picture: string) => `${count} of the ${picture}`,
  },
  /** In place of `answers`, for people who click nothing and can only take a picture again. */
  told: {
    faults: {
      "person-not-found": "Nobody was found in this picture. Show the whole person, upright, in good light, with nothing in front of them.",
      "points-too-close": "The person is too small in this picture. Go nearer.",
      "too-few-points": "Show the whole person, from head to feet. Too little of them is seen here.",
    },
    warnings: {
      "ambiguous-limb-facing": "This picture does not tell whether an arm or a leg comes toward the camera. If you take it again, stand as the good pictures show.",
      "cut-off": "The person reaches the border of the picture. Step back until there is room all around them.",
      "different-people": "The pictures seem to show different people. Check that both show the same person, dressed alike.",
      "left-and-right-may-be-swapped": "Left and right may be mixed up. Take the picture again, turned as the good pictures show.",
      "low-silhouette-overlap": "The body covers little of the person in the picture. Take it again, before a wall of another colour.",
      "nobody-found": "Nobody was found in this picture. Show the whole person, upright, in good light, with nothing in front of them.",
      "other-view": "Take the picture again, turned as it asks: facing the camera for the front, by a quarter for the side, and not mirrored.",
      "segmentation-doubtful": "The person could hardly be told from the background. Take the picture again, before a wall of another colour.",
      "several-people": "Take the picture with one person alone. This one shows several, and the largest is measured.",
      "shoulders-and-hips-disagree": "Left and right may be mixed up. Take the picture again, turned as the good pictures show.",
    },
    verdicts: {
      implausible: "This picture contradicts the body. Take it again: one person alone, from head to feet, standing as the good pictures show.",
      no_person: "No person is seen in this picture. Take it again: the whole person, in good light, with nothing in front of them.",
    },
  },
} as const;

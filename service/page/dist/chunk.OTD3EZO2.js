function t(n,r){return Object.hasOwn(n,r)?n[r]:null}function e(n){return n.replaceAll("_"," ")}export{t as a,e as b};

// a hand-written sample of the water office's list
/* its one storm */
let typhoons = [
  {"tfid": "202106", "name": "烟花", "enname": "In-Fa", "isactive": "1", "warnlevel": "white",
   "land": [{"landaddress": "舟山", "landtime": "2021\/7\/25 12:30:00", "lng": "122.4", "lat": "30.0"}, {"landaddress": "", "landtime": "", "lng": "", "lat": ""}, null, {}],
   "points": [
     {"time": "2021\/7\/25 8:00:00", "lng": "123.0", "lat": "29.7", "strong": "强台风", "power": "14",
      "speed": "42", "pressure": "960", "movespeed": "12", "movedirection": "西北",
      "radius7": "300|200|190|250", "radius10": "100|100|80|90", "radius12": "",
      "forecast": [
        {"tm": "中国", "forecastpoints": [
          {"time": "2021\/7\/25 8:00:00", "lng": "123.0", "lat": "29.7", "strong": "强台风"},
          {"time": "2021\/7\/25 20:00:00", "lng": "122.0", "lat": "30.1", "strong": "台风",
           "power": "12", "speed": "35", "pressure": "970"}]},
        {"tm": "日本", "forecastpoints": [
          {"time": "2021\/7\/25 20:00:00", "lng": "122.2", "lat": "30.4", "speed": "33"}]}]},
     {"time": "2021\/7\/25 14:00:00", "lng": "122.2", "lat": "30.0", "strong": "台风", "power": "13",
      "speed": "38", "pressure": "965", "movespeed": "", "movedirection": "", "radius7": "280",
      "radius10": "", "radius12": ""}]}
];

// The sun's place, against published values and closed forms.
#include "verdure/sun_position.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "verdure/error.h"

namespace verdure {
namespace {

// Reda and Andreas, "Solar Position Algorithm for Solar Radiation Applications", NREL 2008, their
// example: 2003-10-17 12:30:30 at UTC-7, with refraction of 820 mbar (0.004 degrees less here).
TEST(SunPosition, IsThatOfTheSolarPositionAlgorithm) {
  const SunPosition sun =
      sunPosition(parseTime("2003-10-17T12:30:30-07:00"), {39.742476, -105.1786});
  EXPECT_NEAR(90.0 - sun.elevation_deg, 50.11162, 0.02);
  EXPECT_NEAR(180.0 - sun.azimuth_deg, 194.34024, 0.02);  // from north over east
}

// Meeus, example 25.a: 1992-10-13T00:00, declination -7 47' 06". At the pole elevation is
// declination.
TEST(SunPosition, IsThatOfMeeus) {
  EXPECT_NEAR(sunPosition(parseTime("1992-10-13T00:00Z"), {90.0, 0.0}).geometric_deg,
              -(7.0 + 47.0 / 60.0 + 6.0 / 3600.0), 0.002);
}

// Times of the seasons published by the US Naval Observatory.
TEST(SunPosition, HasTheAlmanacsSeasons) {
  const auto declination = [](const char* time) {
    return sunPosition(parseTime(time), {90.0, 0.0}).geometric_deg;
  };
  for (const char* equinox : {"2024-03-20T03:06Z", "2025-03-20T09:01Z", "2025-09-22T18:19Z"})
    EXPECT_NEAR(declination(equinox), 0.0, 0.005) << equinox;
  EXPECT_NEAR(declination("2025-06-21T02:42Z"), 23.436, 0.003);
  EXPECT_NEAR(declination("2025-12-21T15:03Z"), -23.436, 0.003);
}

TEST(SunPosition, FollowsTheDay) {
  // At noon on the northern tropic's solstice the sun is in the zenith; before, it stands east.
  const Place tropic{23.436, 0.0};
  const SunDay day = sunDay(parseTime("2025-06-21T12:00Z"), tropic);
  EXPECT_NEAR(sunPosition(day.noon, tropic).elevation_deg, 90.0, 0.02);
  const Place mid{48.0, 11.0};
  const double noon = sunDay(parseTime("2025-04-10T12:00Z"), mid).noon;
  EXPECT_NEAR(sunPosition(noon, mid).azimuth_deg, 0.0, 0.01);
  EXPECT_GT(sunPosition(noon - 10800.0, mid).direction().x, 0.3f);
  EXPECT_LT(sunPosition(noon + 10800.0, mid).direction().x, -0.3f);
  EXPECT_GT(sunPosition(noon, mid).direction().z, 0.3f);
  EXPECT_LT(sunPosition(noon, {-40.0, 11.0}).direction().z, -0.3f);
  EXPECT_NEAR(glm::length(sunPosition(noon, mid).direction()), 1.0f, 1e-6f);
  // Refraction: 34' at the horizon, next to nothing overhead.
  const double rise = *sunDay(noon, mid).rise;
  EXPECT_NEAR(
      sunPosition(rise + 150.0, mid).elevation_deg - sunPosition(rise + 150.0, mid).geometric_deg,
      34.0 / 60.0, 0.06);
}

TEST(SunDay, IsTheClosedFormOnTheEquator) {
  // Half a day at the equinox: 90 degrees and 50', at the sun's speed of 360 degrees a day.
  const SunDay day = sunDay(parseTime("2025-03-20T12:00Z"), {0.0, 0.0});
  ASSERT_TRUE(day.rise && day.set);
  const double half = (90.0 + 50.0 / 60.0) / 360.0 * 86400.0;
  EXPECT_NEAR(day.noon - *day.rise, half, 15.0);
  EXPECT_NEAR(*day.set - day.noon, half, 15.0);
  // The equation of time that day: the sun is 7 minutes 25 seconds late.
  EXPECT_NEAR(day.noon - parseTime("2025-03-20T12:00Z"), 445.0, 20.0);
}

// Published sunrise and sunset of New York and London, to the minute.
TEST(SunDay, HasTheAlmanacsTimes) {
  const SunDay york = sunDay(parseTime("2024-12-21T12:00-05:00"), {40.7128, -74.006});
  EXPECT_NEAR(*york.rise, parseTime("2024-12-21T07:17-05:00"), 90.0);
  EXPECT_NEAR(*york.set, parseTime("2024-12-21T16:32-05:00"), 90.0);
  const SunDay london = sunDay(parseTime("2024-06-21T23:00+01:00"), {51.5074, -0.1278});
  EXPECT_NEAR(*london.rise, parseTime("2024-06-21T04:43+01:00"), 90.0);
  EXPECT_NEAR(*london.set, parseTime("2024-06-21T21:21+01:00"), 90.0);
  for (const double t : {*york.rise, *york.set})
    EXPECT_NEAR(sunPosition(t, {40.7128, -74.006}).geometric_deg, kSunriseDeg, 1e-3);
}

TEST(SunDay, KnowsPolarDayAndNight) {
  const Place tromso{69.65, 18.96};
  EXPECT_FALSE(sunDay(parseTime("2025-06-21T12:00Z"), tromso).rise);
  EXPECT_FALSE(sunDay(parseTime("2025-12-21T12:00Z"), tromso).rise);
  EXPECT_NO_THROW(checkSunIsUp(parseTime("2025-06-21T23:00Z"), tromso));
  EXPECT_THROW(checkSunIsUp(parseTime("2025-12-21T11:00Z"), tromso), Error);
}

TEST(SunDay, TellsWhenTheSunIsUp) {
  try {
    checkSunIsUp(parseTime("2024-12-21T20:00-05:00"), {40.7128, -74.006});
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(),
                 "sun: the sun is below the horizon at 2024-12-22T01:00Z; it rises at "
                 "2024-12-21T12:17Z and sets at 2024-12-21T21:32Z");
  }
}

TEST(Time, IsReadAndWritten) {
  EXPECT_EQ(parseTime("1970-01-01T00:00Z"), 0.0);
  EXPECT_EQ(parseTime("2000-03-01T00:00:01.5"), 951868801.5);
  EXPECT_EQ(parseTime("2026-06-21T14:30+02:00"), parseTime("2026-06-21T12:30:00Z"));
  EXPECT_EQ(parseTime("2026-06-21T14:30-0130"), parseTime("2026-06-21T16:00Z"));
  EXPECT_EQ(formatTime(parseTime("1969-12-31T23:59Z")), "1969-12-31T23:59Z");
  EXPECT_EQ(formatTime(parseTime("2024-02-29T23:59:40Z")), "2024-03-01T00:00Z");
  for (const char* bad :
       {"", "2026", "2026-06-21", "2026-02-29T12:00Z", "2026-13-01T12:00Z", "2026-06-31T00:00Z",
        "2026-06-21T24:00Z", "2026-06-21T12:60Z", "2026-06-21T12:00:60Z", "2026-06-21T12:00:00.Z",
        "2026-06-21T12:00+2", "2026-06-21T12:00+15:00", "2026-06-21T12:00Zulu", "1899-01-01T00:00Z",
        "2101-01-01T00:00Z", "2026-06-21 12:00", "+026-06-21T12:00Z", "2026-6-21T12:00Z"})
    EXPECT_THROW(parseTime(bad), Error) << bad;
  for (const Place bad : {Place{91, 0}, Place{0, 181}, Place{NAN, 0}, Place{0, NAN}})
    EXPECT_THROW(sunPosition(0.0, bad), Error);
}

}  // namespace
}  // namespace verdure

"""What Yu, Wang, Song and Zhao print, in the units they print it in; of Table I see the table of parameters."""

# Table II, "Proposed model" and "ADAMS/Rail model": root mean squares [m/s^2] and [rad/s^2]; deviations [%].
PROPOSED_RMS = {"lateral": 2.895, "yaw": 0.282}
ADAMS_RMS = {"lateral": 2.788, "yaw": 0.279}
RELATIVE_DEVIATION = {"lateral": 3.838, "yaw": 1.075}
DISTURBANCE = 6.0  # y = sin 6t [rad/s]
SPEED_OF_FIGURE_2 = 250.0  # [km/h]

# Table III [N s/m], and what follows eq. (15).
C_SL, C_SU, C_S = 90_730.0, 2_593_440.0, 1_046_770.0
LAST_DIGIT = 10.0  # of these three
LIMIT = 0.08  # eq. (13)
GOLDEN_SECTION = (0.382, 0.618)  # of C_su and of C_sl

DEGREE_OF_9, DEGREE_OF_11 = 26, 49

# What Table I's K_m, K_mphi, C_m and C_mphi are rounded from; the digits of pi show in them (docs/errata.md, 12).
MOTOR_FREQUENCY, MOTOR_DAMPING_RATIO, PI = 3.0, 0.3, 3.14  # [Hz], [-]

# Section V-A on Figure 3, which has no numbers that could be read off.
OVER_F_M = "decreases first, then increases, and finally tends to be flat"
OVER_XI_M = "decreases first, then increases"
NAMED_F_M = (1.0, 2.0, 2.5, 3.0, 4.0, 5.0, 8.0, 10.0)  # [Hz], spread over the figure
NAMED_XI_M = (0.2, 0.3, 0.4, 0.5, 1.0)

# Section V-B on Figures 4 and 5: number of the figure -> speed [km/h].
SPEEDS_OF_FIGURES = {4: 250.0, 5: 300.0}
SETTLING = "tend to stabilize"

// What may be written into the fields of registers.h, by name.

#ifndef STILLSPIN_HAL_F2808_F2808_VALUES_H
#define STILLSPIN_HAL_F2808_F2808_VALUES_H

// ---- Clocks --------------------------------------------------------------------------------------------
#define PLLCR_DIV_TIMES_5 10u  // SYSCLKOUT = OSCCLK * DIV / 2
#define HISPCP_DIVIDE_BY_8 4u  // 0: /1, n: /2n
#define LOSPCP_DIVIDE_BY_2 1u
#define WDCR_WDCHK_KEY 5u         // any other value resets the chip at once
#define WDCR_WDPS_DIVIDE_BY_4 3u  // n: /2^(n - 1)
#define WDKEY_FIRST 0x55u
#define WDKEY_SECOND 0xAAu
#define FLASH_PAGE_WAIT_STATES 3u  // at 100 MHz
#define FLASH_RANDOM_WAIT_STATES 3u
#define FLASH_OTP_WAIT_STATES 5u

// ---- ePWM ----------------------------------------------------------------------------------------------
#define TBCTL_CTRMODE_UP 0u
#define TBCTL_PRDLD_IMMEDIATE 1u
#define TBCTL_SYNCOSEL_SYNCI 0u
#define TBCTL_SYNCOSEL_ZERO 1u
#define TBCTL_PHSDIR_UP 1u
#define TBCTL_HSPCLKDIV_1 0u  // the reset value divides by 2
#define TBCTL_CLKDIV_1 0u
#define CMPCTL_LOAD_ZERO 0u
#define CMPCTL_SHADOW 0u
#define CMPCTL_IMMEDIATE 1u
#define AQ_CLEAR 1u
#define AQ_SET 2u
#define AQSFRC_IMMEDIATE 3u  // AQCSFRC acts without a shadow
#define AQCSFRC_NONE 0u
#define AQCSFRC_LOW 1u
#define AQCSFRC_HIGH 2u
#define DBCTL_OUT_MODE_BOTH 3u
#define DBCTL_POLSEL_LOW_COMPLEMENTARY 1u
#define DBCTL_POLSEL_HIGH_COMPLEMENTARY 2u
#define DBCTL_IN_MODE_A 0u
#define TZCTL_FORCE_HIGH 1u
#define TZCTL_FORCE_LOW 2u
#define ET_ZERO 1u
#define ET_CMPA_UP 4u
#define ET_CMPB_UP 6u
#define ET_NO_EVENT 0u
#define ET_EVERY_EVENT 1u

// From the master's zero to the slave's phase load when TBCLK = SYSCLKOUT. A slave that shall run in step with the
// master is therefore loaded with what the master has counted meanwhile.
#define EPWM_SYNC_DELAY_TICKS 2u

// ---- ADC -----------------------------------------------------------------------------------------------
#define ADCTRL3_BANDGAP_ON 3u
#define ADCTRL3_SMODE_SIMULTANEOUS 1u

// ---- Encoder -------------------------------------------------------------------------------------------
#define QDECCTL_QSRC_QUADRATURE 0u
#define QEPCTL_PCRM_MAXIMUM 1u
#define QEPCTL_FREE_RUN 2u

// ---- Serial port ---------------------------------------------------------------------------------------
#define SCICHAR_8_BITS 7u
#define SCI_FIFO_LEVEL_NEVER 31u  // the FIFO has 16 words

// ---- Pins ----------------------------------------------------------------------------------------------
#define GPIO_MUX_GPIO 0u
#define GPIO_MUX_FIRST 1u  // ePWM on GPIO0..11, TZ 12..15, eQEP1 20..23, SCI-A 28, 29, eCAN-A 30, 31, I2C-A 32, 33
#define GPIO_QUALIFY_6_SAMPLES 2u
#define GPIO_QUALIFY_NONE 3u     // asynchronous
#define GPACTRL_QUALPRD2_LSB 16  // sampling period of GPIO16..23 is 2n SYSCLKOUT
#define GPACTRL_QUALPRD2_MASK 0x00FF0000uL

#endif
